#include "display/session.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace musclesim {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

void waitUntil(const std::string& what, const std::function<bool()>& done) {
  for (int i = 0; i < 6000; ++i) {
    if (done()) return;
    std::this_thread::sleep_for(10ms);
  }
  throw std::runtime_error("waited a minute in vain: " + what);
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    if (!stream.eof()) lines.push_back(line);  // the last one may be half written
  return lines;
}

pid_t start(const std::vector<std::string>& arguments, const fs::path& folder, const std::string& display) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child > 0) return child;
  if (chdir(folder.c_str()) != 0) _exit(126);
  const int out = open("output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  setenv("DISPLAY", display.c_str(), 1);
  std::vector<char*> argv;
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  _exit(127);
}

}  // namespace

std::string XServer::missing() {
  for (const char* program : {"Xvfb", "xdotool"})
    if (std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) != 0)
      return std::string(program) + " is not installed";
  return "";
}

XServer::XServer() {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("pipe failed");
  child_ = fork();
  if (child_ == 0) {
    close(ends[0]);
    const std::string number = std::to_string(ends[1]);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1280x1024x24", "-noreset", "-nolisten", "tcp", nullptr);
    _exit(127);
  }
  close(ends[1]);
  char digit = 0;
  display_ = ":";
  while (read(ends[0], &digit, 1) == 1 && digit != '\n') display_ += digit;
  close(ends[0]);
  if (display_ == ":") throw std::runtime_error("Xvfb does not start");
}

XServer::~XServer() {
  kill();
}

void XServer::kill() {
  if (child_ <= 0) return;
  ::kill(child_, SIGTERM);
  waitpid(child_, nullptr, 0);
  child_ = -1;
}

Session::Session(const XServer& server, const fs::path& folder, std::vector<std::string> arguments)
    : display_(server.display()), folder_(folder) {
  arguments.insert(arguments.begin(), MUSCLESIM_PROGRAM);
  if (std::ranges::find(arguments, "--out") == arguments.end()) arguments.insert(arguments.end(), {"--out", "run"});
  arguments.insert(arguments.end(), {"--window-log", "window.jsonl"});
  child_ = start(arguments, folder, display_);
  // The first lines report that the window exists.
  waitUntil("window", [&] { return lineCount() >= 1 || !isAlive(); });
  xdotool("mousemove 150 200");
}

Session::~Session() {
  if (isAlive()) {
    ::kill(child_, SIGKILL);
    exitStatus();
  }
}

void Session::xdotool(const std::string& words) const {
  const std::string command = "DISPLAY=" + display_ + " xdotool " + words + " >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: xdotool " + words);
}

std::size_t Session::lineCount() const {
  return linesOf(folder_ / "window.jsonl").size();
}

nlohmann::json Session::stateAfter(std::size_t line_count) const {
  waitUntil("line " + std::to_string(line_count) + " of the window's log", [&] { return lineCount() >= line_count; });
  return nlohmann::json::parse(linesOf(folder_ / "window.jsonl").back());
}

nlohmann::json Session::press(const std::string& key, int times) {
  const std::size_t before = lineCount();
  std::string words = "key --delay 8";
  for (int i = 0; i < times; ++i) words += " " + key;
  xdotool(words);
  return stateAfter(before + static_cast<std::size_t>(times));
}

void Session::runUntil(double time_s) {
  waitUntil(std::to_string(time_s) + " s of the run", [&] { return press("0")["time_s"] > time_s; });
}

void Session::requestClose() const {
  ::Display* display = XOpenDisplay(display_.c_str());
  if (!display) throw std::runtime_error("cannot connect to " + display_);
  ::Window root, parent, *children = nullptr;
  unsigned int count = 0;
  XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
  for (unsigned int i = 0; i < count; ++i) {
    XEvent event = {};
    event.xclient.type = ClientMessage;
    event.xclient.window = children[i];
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    XSendEvent(display, children[i], False, NoEventMask, &event);
  }
  XFree(children);
  XCloseDisplay(display);
}

void Session::signal(int number) const {
  ::kill(child_, number);
}

bool Session::isAlive() {
  if (child_ <= 0) return false;
  int status = 0;
  if (waitpid(child_, &status, WNOHANG) == 0) return true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  child_ = -1;
  return false;
}

int Session::exitStatus() {
  for (int i = 0; i < 600 && isAlive(); ++i) std::this_thread::sleep_for(100ms);
  if (isAlive()) {
    ::kill(child_, SIGKILL);
    while (isAlive()) std::this_thread::sleep_for(10ms);
  }
  return status_;
}

}  // namespace musclesim
