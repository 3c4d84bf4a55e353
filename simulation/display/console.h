/// The user's actions in a window and what the window shows as a result. Independent of any windowing library.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "musclesim/controller/manual.h"
#include "pace.h"
#include "player.h"
#include "simulation/scene/camera.h"
#include "simulation/scene/scene.h"

namespace musclesim {

/// Key codes: a lower-case character, or one of these.
namespace key {
inline constexpr int escape = 27, f1 = 1001, up = 1002, down = 1003, left = 1004, right = 1005, home = 1006, end = 1007, tab = 9;
}

class Console {
 public:
  /// For a run. `hands` and `pace` belong to it; it may be in another thread.
  Console(ManualController& hands, Pace& pace, const Camera& first);
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

  /// Of a run.
  ManualController& hands() const { return *hands_; }
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
  bool wants_screenshot = false, wants_video = false;
  std::optional<std::string> divergence;  ///< text of the banner

  /// All of the above, for logs and tests.
  nlohmann::json state() const;

 private:
  nlohmann::json replayState() const;

  ManualController* hands_ = nullptr;
  Player* player_ = nullptr;
  Pace& pace_;
  Camera first_camera_;
  int muscle_count_;
  std::string notice_;
  std::chrono::steady_clock::time_point notice_until_;
};

}  // namespace musclesim
