/// Independent pieces of work on several threads.
#pragma once

#include <functional>

namespace musclesim {

/// Calls work(0) .. work(count - 1), each once, on up to `job_count` threads (0: one per core). Returns when all have ended; the first
/// exception by index is thrown again then. What work(i) does must not depend on which thread it runs on. A call within a piece of work
/// shares the threads of the call around it: those that have nothing else to do help. With one job it keeps to its own thread.
void parallelFor(int count, int job_count, const std::function<void(int)>& work);

}  // namespace musclesim
