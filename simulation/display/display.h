/// The window: shows a run in progress and lets the user control it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "display_options.h"
#include "player.h"
#include "run_request.h"
#include "simulation/snapshot.h"

namespace musclesim {

struct DisplayShared;  // shared.h

/// A window with a thread of its own, so that its frame rate does not depend on the cost of a step. At most one per process at a time.
/// After a loss() that thread never ends and holds the display; the program must then end with _Exit.
class Display {
 public:
  using Interrupted = std::function<bool()>;

  /// Opens the window. Throws SceneError if there is no display or it cannot draw the scene, IoError if the display is lost during that.
  Display(DisplayOptions options, ShownRun run, Snapshot first);
  /// The same for a replay, which it plays until the user closes it.
  Display(DisplayOptions options, std::unique_ptr<Player> player);
  /// Closes it.
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  /// Another run takes the place of the present one.
  void begin(ShownRun run, Snapshot first);
  /// Shows the snapshot and waits until the run may continue. Returns false if the user has closed the window or wants another run, or
  /// `interrupted` returns true.
  bool show(Snapshot snapshot, const Interrupted& interrupted);
  /// The same without waiting, for a run that repeats inputs.
  bool showAtOnce(Snapshot snapshot, const Interrupted& interrupted);
  /// The run that the user wants next, once; none: no other.
  std::optional<RunRequest> takeRequest();
  bool isAsked() const;
  /// Shows the user a line for some seconds.
  void say(const std::string& message);
  /// Shows the banner of a divergence and waits until the user closes the window or wants another run, or `interrupted` returns true.
  void showDivergence(const std::string& message, const Interrupted& interrupted);
  /// Waits until the user closes the window or `interrupted` returns true.
  void waitForEnd(const Interrupted& interrupted);

  /// Why the window failed: a lost connection, an X error, a failure to draw. Empty if it is open or was closed by the user.
  std::optional<std::string> loss() const;

  /// Mean number of pictures per second since the window was opened.
  double framesPerS() const;

 private:
  void open();

  std::unique_ptr<DisplayShared> shared_;
  std::jthread thread_;
};

}  // namespace musclesim
