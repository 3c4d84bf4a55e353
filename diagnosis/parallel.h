/// Independent pieces of work on several threads.
#pragma once

#include <functional>

namespace musclesim {

/// Calls work(0) .. work(count - 1), each once, on up to `job_count` threads (0: one per core). Returns when all have ended; the first
/// exception by index is thrown again then. What work(i) does must not depend on which thread it runs on.
void parallelFor(int count, int job_count, const std::function<void(int)>& work);

}  // namespace musclesim
