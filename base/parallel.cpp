#include "parallel.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

namespace musclesim {

namespace {

struct Batch {
  const std::function<void(int)>& work;
  int count;
  int next = 0;      ///< the first piece that no thread has taken
  int open = count;  ///< pieces that have not ended
  std::vector<std::exception_ptr> failures = std::vector<std::exception_ptr>(static_cast<std::size_t>(count));

  void rethrow() const {
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }
};

/// Threads that work on the pieces of all batches, oldest batch first. The thread that adds a batch works on it, too.
class Crew {
 public:
  explicit Crew(int thread_count) : before_(current_) {
    current_ = this;
    for (int i = 1; i < thread_count; ++i) threads_.emplace_back([this] { help(); });
  }
  ~Crew() {
    current_ = before_;
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// The crew that the calling thread belongs to; null: none.
  static Crew* current() { return current_; }

  void run(Batch& batch) {
    std::unique_lock lock(mutex_);
    batches_.push_back(&batch);
    wake_.notify_all();
    while (batch.next < batch.count) takeTurn(batch, lock);
    ended_.wait(lock, [&] { return batch.open == 0; });
  }

 private:
  void help() {
    current_ = this;
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return stopping_ || !batches_.empty(); });
      if (batches_.empty()) return;
      takeTurn(*batches_.front(), lock);
    }
  }

  void takeTurn(Batch& batch, std::unique_lock<std::mutex>& lock) {
    const int piece = batch.next++;
    if (batch.next == batch.count) batches_.remove(&batch);
    lock.unlock();
    try {
      batch.work(piece);
    } catch (...) {
      batch.failures[static_cast<std::size_t>(piece)] = std::current_exception();
    }
    lock.lock();
    if (--batch.open == 0) ended_.notify_all();
  }

  static thread_local Crew* current_;
  Crew* before_;
  std::mutex mutex_;
  std::condition_variable wake_, ended_;
  std::list<Batch*> batches_;  ///< batches with pieces that no thread has taken
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

thread_local Crew* Crew::current_ = nullptr;

}  // namespace

void parallelFor(int count, int job_count, const std::function<void(int)>& work) {
  if (count <= 0) return;
  Batch batch{work, count};
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int thread_count = job_count > 0 ? job_count : cores;
  if (Crew::current() && thread_count > 1)
    Crew::current()->run(batch);
  else
    Crew(thread_count).run(batch);
  batch.rethrow();
}

}  // namespace musclesim
