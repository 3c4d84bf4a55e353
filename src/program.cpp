#include "musclesim/program.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <system_error>

#include "command_line.h"
#include "interrupt.h"
#include "musclesim/base/error.h"

namespace musclesim {

namespace {

using namespace command_line;

int complain(const std::exception& error, ExitStatus status) {
  tell(std::string("error: ") + error.what());
  return status;
}

/// Runs the command and returns its exit status.
int statusOf(int argument_count, char** arguments) {
  watchInterrupts();
  try {
    CommandLine line;
    const std::optional<int> at_once = line.parse(argument_count, arguments);
    const int status = at_once ? *at_once : line.run();
    if (std::fflush(stdout) != 0) throw IoError("standard output: cannot be written");
    return status;
  } catch (const BadParameter& error) {
    return complain(error, bad_usage);
  } catch (const BadFile& error) {
    return complain(error, bad_input);
  } catch (const Diverged& error) {
    return complain(error, diverged);
  } catch (const IoError& error) {
    return complain(error, io_error);
  } catch (const Interrupted&) {
    return interrupted_base + interruptSignal();
  } catch (const std::system_error& error) {  // from file systems and output
    return complain(error, io_error);
  } catch (const std::exception& error) {
    return complain(error, internal_error);
  }
}

}  // namespace

int program(int argument_count, char** arguments) {
  const int status = statusOf(argument_count, arguments);
  if (status != done) std::_Exit(status);  // after a caught fault of ODE, its cleanup at exit is not safe
  return status;
}

}  // namespace musclesim
