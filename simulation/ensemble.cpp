#include "musclesim/simulation/ensemble.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "musclesim/base/error.h"

namespace musclesim {

void runEnsemble(int count, int thread_count, const std::function<void(int)>& work) {
  if (count < 0) throw BadParameter("number of simulations", std::to_string(count), "be at least 0");
  if (thread_count < 0) throw BadParameter("number of threads", std::to_string(thread_count), "be at least 0");
  if (thread_count == 0) thread_count = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::exception_ptr> faults(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  const auto take = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        faults[static_cast<std::size_t>(i)] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < std::min(thread_count, count); ++i) others.emplace_back(take);
  take();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
}

}  // namespace musclesim
