/// How Ctrl-C ends work that goes on without Python's lock.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <optional>

#include "bindings.h"

namespace musclesim::python {

/// Asks Python, now and then, whether the work of the calling thread should end. Python notes Ctrl-C in its main thread; in others,
/// ensembles ask for the end (bindStopping).
class Interruption {
 public:
  /// Whether to end. To be asked by the thread that made this object, with or without Python's lock.
  bool isWanted();
  /// Throws the exception that asked for the end, if one did.
  void rethrow() const;

 private:
  void ask();

  std::optional<py::error_already_set> error_;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Does `work` in another thread without Python's lock. Meanwhile the calling thread asks for interruptions and calls `meanwhile`, with
/// Python's lock, some twenty times a second. `work` gets a function that says whether to end soon. An exception of `meanwhile` ends the
/// work, too. Throws what asked for the end, or else what `work` threw.
void watched(const std::function<void(const std::function<bool()>& interrupted)>& work, const std::function<void()>& meanwhile);

/// Stop: a flag with set(), and work_of_thread(): from now on the calling thread's work ends when the flag is set.
void bindStopping(py::module_& module);

}  // namespace musclesim::python
