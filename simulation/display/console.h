/// The user's actions in a window and what the window shows as a result. Independent of any windowing library.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pace.h"
#include "player.h"
#include "run_request.h"
#include "simulation/scene/camera.h"
#include "simulation/scene/scene.h"

namespace musclesim {

/// Key codes: a lower-case character, or one of these.
namespace key {
inline constexpr int escape = 27, f1 = 1001, up = 1002, down = 1003, left = 1004, right = 1005, home = 1006, end = 1007, page_up = 1008,
                     page_down = 1009, tab = 9;
}

class Console {
 public:
  /// For a run, which may be in another thread.
  Console(std::shared_ptr<const ShownRun> run, Pace& pace);
  /// For a replay.
  Console(Player& player, Pace& pace, const Camera& first);

  /// A key and what it does, for the help overlay and the documentation.
  struct Binding {
    std::string keys, meaning;
    std::vector<int> codes;
    void (*act)(Console&, int code);
  };
  /// The keys of the window of a run.
  static const std::vector<Binding>& bindingsOfRun();
  /// The keys of the window of a replay.
  static const std::vector<Binding>& bindingsOfReplay();
  const std::vector<Binding>& bindings() const { return player_ ? bindingsOfReplay() : bindingsOfRun(); }

  /// Performs the action of a key; returns false if the key has none.
  bool press(int code);
  void select(int muscle);
  void raise(double by_ratio);
  /// Sets a pressure by hand; tells the user if this starts manual control.
  void setPressure(int muscle, double pressure_ratio);
  void toggleManual();

  /// Shows another run from now on.
  void attach(std::shared_ptr<const ShownRun> run);
  /// Asks for the present run again, from its beginning.
  void resetRun();
  /// Asks for a run of another robot, with its usual controller, or of the same robot under another controller.
  void chooseRobot(const std::string& robot) { wanted_run = RunRequest{robot, ""}; }
  void chooseController(const std::string& controller) { wanted_run = RunRequest{run_->robot, controller}; }
  /// Keeps the present state for restore().
  void save();
  /// Asks for a saved state, by its place in saved(); then pauses.
  void restore(std::size_t which);
  void restoreLast();
  const std::vector<RunRequest>& saved() const { return saved_; }
  /// A higher or lower target, and any other place for it.
  void raiseTarget(float by_mm);
  void moveTarget(const Eigen::Vector3f& to_mm);

  /// Of a run.
  Hands& hands() const { return *run_->hands; }
  const ShownRun& run() const { return *run_; }
  /// Null for a run.
  Player* player() const { return player_; }
  Pace& pace() const { return pace_; }
  int muscleCount() const { return muscle_count_; }
  /// Replays: plays on by a time on the wall.
  void play(double wall_s);
  void togglePause();
  /// The user's changes of the view.
  void resetView();
  void zoom(float factor);
  void rotate(float right_px, float down_px);
  void pan(float right_px, float down_px, float height_px);
  /// To be called before every picture.
  void keepInView(const Bounds& bounds, float width_px, float height_px);
  void toggleEffects();
  void toggleGhost();
  int selected() const { return style.selected; }

  /// Shows the user a line for some seconds.
  void say(const std::string& message);
  std::string notice() const;

  Camera camera;
  SceneStyle style;
  bool show_help = false, show_panel = true;
  bool keeps_in_view = false;  ///< moves the camera away until the whole robot is visible; until the user moves it
  std::set<std::string> hidden_plots = {"hand x", "hand z"};  ///< plots of the panel that the user does not want
  std::vector<std::string> robots, controllers;               ///< among which the user may choose for the next run
  bool wants_screenshot = false, wants_video = false;
  std::optional<std::string> divergence;     ///< text of the banner
  std::optional<RunRequest> wanted_run;      ///< another run that the user wants
  std::optional<Eigen::Vector3f> target_mm;  ///< of the run, as it is drawn

  /// All of the above, for logs and tests.
  nlohmann::json state() const;

 private:
  nlohmann::json replayState() const;

  std::shared_ptr<const ShownRun> run_;
  std::vector<RunRequest> saved_;
  Player* player_ = nullptr;
  Pace& pace_;
  Camera first_camera_;
  int muscle_count_;
  std::string notice_;
  std::chrono::steady_clock::time_point notice_until_;
};

}  // namespace musclesim
