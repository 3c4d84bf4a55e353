/// The window of a Display: GLUT's callbacks, drawing, pictures and videos. Use it only in the thread that made it.
#pragma once

#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "console.h"
#include "grab.h"
#include "history.h"
#include "panel.h"
#include "shared.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/video.h"
#include "time_line.h"

namespace musclesim {

class Window {
 public:
  /// Throws SceneError if there is no display or OpenGL is too old.
  explicit Window(DisplayShared& shared);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Runs until the run or the user ends it.
  void loop();

 private:
  using Clock = std::chrono::steady_clock;
  void open();
  void listen();
  void closed();
  void draw();
  void drawOver(const Snapshot& snapshot);
  void play();
  void follow();
  void showMovedTarget();
  void fitTarget();
  void watchCost(Clock::duration cost);
  void press(int code);
  /// What is to be seen now.
  const Snapshot& current() const { return *seen_; }
  TimeLine timeLine() const;
  void scrubTo(int x);
  bool scrub(int which, int state, int x, int y);
  void button(int which, int state, int x, int y);
  void drag(int x, int y);
  void pickMuscle(int x, int y);
  void grab(int x, int y);
  void dragGrabbed(int x, int y);
  void letGo();
  void savePictures();
  void saveScreenshot();
  void updateVideo();
  std::string fileFor(const char* extension) const;
  void log(const std::string& event);

  DisplayShared& shared_;
  std::shared_ptr<const Snapshot> seen_;
  Console console_;
  History history_;
  Gl gl_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<GpuTarget> target_;
  std::unique_ptr<Panel> panel_;
  std::unique_ptr<VideoWriter> video_;
  Clock::time_point video_start_;
  bool is_smooth_ = true;  ///< several samples per pixel, while that is fast enough
  Clock::duration mean_cost_ = {};
  std::ofstream log_;
  int window_ = 0, width_, height_;
  int dragged_button_ = -1, last_x_ = 0, last_y_ = 0;
  bool has_moved_ = false, is_scrubbing_ = false;
  std::optional<Grab> grab_;
  Clock::time_point played_at_ = Clock::now();
};

}  // namespace musclesim
