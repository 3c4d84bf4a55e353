#include "interruption.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace musclesim::python {

namespace {

/// Python's lock is asked for once per interval, so that asking costs nothing beside a step.
constexpr std::chrono::milliseconds ask_interval{20}, watch_interval{50};

struct Stop {
  std::shared_ptr<std::atomic<bool>> flag = std::make_shared<std::atomic<bool>>(false);
};

thread_local std::shared_ptr<const std::atomic<bool>> stop_of_thread;

}  // namespace

bool Interruption::isWanted() {
  if (!error_ && !stopped_) ask();
  return error_ || stopped_;
}

void Interruption::ask() {
  stopped_ = stop_of_thread && *stop_of_thread;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < ask_interval) return;
  last_ = now;
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) error_.emplace();
}

void Interruption::rethrow() const {
  if (error_) throw py::error_already_set(*error_);
  if (!stopped_) return;
  const py::gil_scoped_acquire lock;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

void watched(const std::function<void(const std::function<bool()>&)>& work, const std::function<void()>& meanwhile) {
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  std::exception_ptr failure, refusal;
  std::thread worker([&] {
    try {
      work([&] { return stop.load(); });
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    has_ended = true;
    ended.notify_one();
  });
  Interruption interruption;
  {
    const py::gil_scoped_release unlocked;
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, watch_interval, [&] { return has_ended; })) {
      lock.unlock();
      if (interruption.isWanted()) stop = true;
      if (!stop) {
        const py::gil_scoped_acquire locked;
        try {
          meanwhile();
        } catch (...) {
          refusal = std::current_exception();
          stop = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  interruption.rethrow();
  if (refusal) std::rethrow_exception(refusal);
  if (failure) std::rethrow_exception(failure);
}

void bindStopping(py::module_& module) {
  py::class_<Stop>(module, "_Stop", "A flag that ends the work of the threads that follow it.")
      .def(py::init<>())
      .def(
          "set", [](const Stop& stop) { *stop.flag = true; }, "The threads' work ends soon, in KeyboardInterrupt.")
      .def(
          "follow", [](const Stop& stop) { stop_of_thread = stop.flag; }, "The calling thread's work ends once the flag is set.");
}

}  // namespace musclesim::python
