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
  long number = 0;   ///< in the order of addition
  std::vector<std::exception_ptr> failures = std::vector<std::exception_ptr>(static_cast<std::size_t>(count));

  void rethrow() const {
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }
};

/// Threads that work on the pieces of all batches, oldest batch first. The thread that adds a batch works on it, too, and then on batches
/// that were added later, until its own has ended: those are mostly parts of the pieces of its own batch that other threads work on.
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
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// The crew that the calling thread belongs to; null: none.
  static Crew* current() { return current_; }

  void run(Batch& batch) {
    std::unique_lock lock(mutex_);
    batch.number = next_number_++;
    batches_.push_back(&batch);
    changed_.notify_all();
    while (batch.open > 0) {
      if (batch.next < batch.count)
        takeTurn(batch, lock);
      else if (!batches_.empty() && batches_.back()->number > batch.number)
        takeTurn(*batches_.back(), lock);
      else
        changed_.wait(lock);
    }
  }

 private:
  void help() {
    current_ = this;
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return stopping_ || !batches_.empty(); });
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
    if (--batch.open == 0) changed_.notify_all();
  }

  static thread_local Crew* current_;
  Crew* before_;
  std::mutex mutex_;
  std::condition_variable changed_;  ///< a batch was added or has ended, or the crew stops
  std::list<Batch*> batches_;        ///< batches with pieces that no thread has taken
  long next_number_ = 0;
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
