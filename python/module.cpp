#include "bindings.h"
#include "interruption.h"
#include "musclesim/version.h"

namespace musclesim::python {

// NOLINTNEXTLINE: the macro's own names
PYBIND11_MODULE(_musclesim, module) {
  module.doc() = "Compiled core of the package musclesim. Use the names of the package.";
  module.attr("__version__") = MUSCLESIM_VERSION;
  translateErrors();
  bindRecording(module);
  bindControllers(module);
  bindForceLaws(module);
  bindSimulation(module);
  bindReplay(module);
  bindDiagnosis(module);
  bindCatalogues(module);
  bindStopping(module);
}

}  // namespace musclesim::python
