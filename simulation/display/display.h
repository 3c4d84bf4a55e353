/// The window: shows a run while it goes on and lets a hand steer it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "musclesim/controller/manual.h"
#include "pace.h"
#include "simulation/scene/camera.h"
#include "simulation/snapshot.h"

namespace musclesim {

struct DisplayOptions {
  std::string title = "musclesim";
  int width_px = 1024, height_px = 768;
  double speed_ratio = 1;  ///< simulated time over wall time
  Camera camera;
  std::string picture_folder;  ///< where the keys s and v put pictures and videos
  std::string log_file;        ///< one line of JSON per key or click with the state after it; empty: none
};

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

  struct Shared;

 private:
  std::unique_ptr<Shared> shared_;
  std::jthread thread_;
};

}  // namespace musclesim
