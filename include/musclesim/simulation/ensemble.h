/// Many simulations in one process, one per thread at a time.
#pragma once

#include <functional>

namespace musclesim {

/// Calls work(0) .. work(count - 1), each once, on so many threads (0: one per processor). Every call builds and runs simulations of its
/// own and writes to places of its own; simulations share nothing, so each gets the bits that it gets alone, whatever the number of
/// threads. If calls throw, the others still run, and then the exception of the lowest number is thrown.
void runEnsemble(int count, int thread_count, const std::function<void(int)>& work);

}  // namespace musclesim
