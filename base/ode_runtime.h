/// ODE's process-wide state: initialisation per thread, and handlers that throw instead of aborting the process.
#pragma once

#include <string>

namespace musclesim::ode_runtime {

/// Initialises ODE once per process and its data once per calling thread; installs the handlers. Cheap when done before.
/// Throws OdeFault if ODE was built with single precision or cannot be initialised.
void prepareThread();

/// ODE's messages ("LCP internal error ...") are not errors to ODE. They are counted per thread; the last text is kept.
struct Messages {
  long count = 0;
  std::string last;
};
Messages& messagesOfThread();

}  // namespace musclesim::ode_runtime
