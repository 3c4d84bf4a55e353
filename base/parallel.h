/// Runs independent pieces of work on several threads.
#pragma once

#include <functional>

namespace musclesim {

/// Calls work(0) .. work(count - 1), each once, on up to `job_count` threads (0: one per core). Returns when all have ended; if some threw,
/// rethrows the exception of the lowest index. The result of work(i) must not depend on the thread. A nested call, made within work(i),
/// uses the idle threads of the outer call; a thread whose own pieces have ended may therefore take a piece of another nested call before
/// its call returns, so that work must not call while it holds a lock. With job_count 1 all work runs on the calling thread.
void parallelFor(int count, int job_count, const std::function<void(int)>& work);

}  // namespace musclesim
