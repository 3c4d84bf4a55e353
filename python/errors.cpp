#include <exception>
#include <string>

#include "bindings.h"
#include "musclesim/base/error.h"

namespace musclesim::python {

namespace {

py::object errorOf(const char* name, const std::string& message) {
  return py::module_::import("musclesim._errors").attr(name)(message);
}

void raise(const py::object& error) {
  PyErr_SetObject(py::type::handle_of(error).ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11 asks for a value
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const BadParameter& error) {
    raise(errorOf("BadParameter", error.what()));
  } catch (const BadFile& error) {
    const py::object raised = errorOf("BadFile", error.what());
    raised.attr("file") = error.file();
    raised.attr("line") = error.line();
    raised.attr("column") = error.column();
    raise(raised);
  } catch (const Diverged& error) {
    const py::object raised = errorOf("Diverged", error.what());
    raised.attr("time_s") = error.time_s();
    raised.attr("where") = error.where();
    raise(raised);
  } catch (const IoError& error) {
    raise(errorOf("IoError", error.what()));
  } catch (const Error& error) {
    raise(errorOf("Error", error.what()));
  }
}

}  // namespace

void translateErrors() {
  py::register_exception_translator(translate);
}

}  // namespace musclesim::python
