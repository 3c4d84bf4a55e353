/// The window: shows a run while it goes on and lets a hand steer it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "display_options.h"
#include "musclesim/controller/manual.h"
#include "simulation/scene/snapshot.h"

namespace musclesim {

struct DisplayShared;  // shared.h

/// A window with a thread of its own, so that the picture keeps its rate whatever a step costs. At most one in a process at a time. After
/// a loss() that thread never ends and holds the display: a program must leave by _Exit then.
class Display {
 public:
  using Interrupted = std::function<bool()>;

  /// Opens the window. Throws SceneError where there is no display or it cannot draw the scene, IoError where the display is lost
  /// meanwhile.
  Display(DisplayOptions options, ManualController& hands, Snapshot first);
  /// Closes it.
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  /// Shows the moment and waits until it is time to go on. False: the user has closed the window, or `interrupted` says so.
  bool show(Snapshot snapshot, const Interrupted& interrupted);
  /// Shows the banner of a divergence and waits until the user closes the window or `interrupted` says so.
  void showDivergence(const std::string& message, const Interrupted& interrupted);

  /// Why the window ended on its own: a lost connection, an X error, a failure to draw. Empty if it is open or somebody closed it.
  std::optional<std::string> loss() const;

  /// Pictures drawn so far over the time since the window was opened.
  double framesPerS() const;

 private:
  std::unique_ptr<DisplayShared> shared_;
  std::jthread thread_;
};

}  // namespace musclesim
