/// Starts ODE: initialises it per process and per thread, and installs handlers that throw instead of aborting the process.
#pragma once

#include <string>

namespace musclesim::ode_runtime {

/// Initialises ODE once per process and its data once per calling thread, and installs the handlers. Repeated calls are cheap.
/// Throws OdeFault if ODE was built with single precision or cannot be initialised.
void prepareThread();

/// ODE reports some problems ("LCP internal error ...") as messages, not errors. They are counted per thread; the last text is kept.
struct Messages {
  long count = 0;
  std::string last;
};
Messages& messagesOfThread();

}  // namespace musclesim::ode_runtime
