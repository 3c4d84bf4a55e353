/// An X server with a window of musclesim, controlled by real key and mouse events.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim {

/// Xvfb on a free display.
class XServer {
 public:
  /// Names the missing one of Xvfb and xdotool; empty if both are installed.
  static std::string missing();
  XServer();
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;
  const std::string& display() const { return display_; }
  void kill();

 private:
  pid_t child_ = -1;
  std::string display_;
};

/// The program with a window, running in a folder. Its recording goes to run/run.csv in that folder unless the arguments have an --out,
/// the window's log to window.jsonl.
class Session {
 public:
  /// Waits until the window has drawn and the pointer is over its middle. Throws std::runtime_error if that takes a minute.
  Session(const XServer& server, const std::filesystem::path& folder, std::vector<std::string> arguments);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Presses keys (X names), waits until the window has handled all of them, and returns its state after the last.
  nlohmann::json press(const std::string& key, int times = 1);
  /// Runs xdotool with words separated by spaces.
  void xdotool(const std::string& words) const;
  /// Waits until the window's log has this number of lines and returns the last.
  nlohmann::json stateAfter(std::size_t line_count) const;
  std::size_t lineCount() const;
  /// Presses a key that does not affect the run until the run's clock shows more than this; earlier the run may still be settling.
  void runUntil(double time_s);
  /// Closes the window as a window manager would.
  void requestClose() const;
  void signal(int number) const;
  bool isAlive();
  /// Waits for the end, a minute at most; 128 + signal if it had to be killed.
  int exitStatus();

 private:
  std::string display_;
  std::filesystem::path folder_;
  pid_t child_ = -1;
  int status_ = -1;
};

}  // namespace musclesim
