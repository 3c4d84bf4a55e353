/// Many simulations in one process, one per thread at a time.
#pragma once

#include <functional>

namespace musclesim {

/// Calls work(0) .. work(count - 1) once each on `thread_count` threads (0: one per processor). Every call must build and run its own
/// simulations and write to its own memory. Simulations share nothing, so results do not depend on the number of threads, to the bit. If
/// calls throw, the other calls still run, and then the exception of the call with the lowest number is rethrown.
void runEnsemble(int count, int thread_count, const std::function<void(int)>& work);

}  // namespace musclesim
