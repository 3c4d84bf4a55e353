/// The program `musclesim`: reads the command line, runs one command, turns errors into exit statuses.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <system_error>

#include "command_line.h"
#include "interrupt.h"
#include "musclesim/base/error.h"

namespace {

using namespace musclesim;
using namespace musclesim::program;

int complain(const std::exception& error, ExitStatus status) {
  std::fprintf(stderr, "musclesim: error: %s\n", error.what());
  return status;
}

}  // namespace

int main(int argument_count, char** arguments) {
  watchInterrupts();
  try {
    CommandLine command_line;
    const std::optional<int> at_once = command_line.parse(argument_count, arguments);
    const int status = at_once ? *at_once : command_line.run();
    if (std::fflush(stdout) != 0) throw IoError("standard output: cannot be written");
    // After a caught fault of ODE, its cleanup at exit is not safe: leave without it.
    std::_Exit(status);
  } catch (const BadParameter& error) {
    std::_Exit(complain(error, bad_usage));
  } catch (const BadFile& error) {
    std::_Exit(complain(error, bad_input));
  } catch (const Diverged& error) {
    std::_Exit(complain(error, diverged));
  } catch (const IoError& error) {
    std::_Exit(complain(error, io_error));
  } catch (const Interrupted&) {
    std::_Exit(interrupted_base + interruptSignal());
  } catch (const std::system_error& error) {  // from file systems and output
    std::_Exit(complain(error, io_error));
  } catch (const std::exception& error) {
    std::_Exit(complain(error, internal_error));
  }
}
