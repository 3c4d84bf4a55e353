#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace musclesim {

void parallelFor(int count, int job_count, const std::function<void(int)>& work) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int thread_count = std::min(count, job_count > 0 ? job_count : cores);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(std::max(0, count)));
  std::atomic<int> next{0};
  auto takeTurns = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[static_cast<std::size_t>(i)] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < thread_count; ++i) threads.emplace_back(takeTurns);
  takeTurns();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace musclesim
