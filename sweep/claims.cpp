#include "claims.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/unique_name.h"
#include "sweep.h"

namespace musclesim {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t claim_limit_bytes = std::size_t{1} << 20;
constexpr std::array<const char*, 3> end_names = {"crashed", "killed", "abandoned"};

std::string firstLine(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Identifies one boot of one machine and one container: only within it does a process id identify a process.
std::string thisMachine() {
  std::error_code error;
  const auto ids = fs::read_symlink("/proc/self/ns/pid", error).string();
  return firstLine("/proc/sys/kernel/random/boot_id") + " " + ids;
}

/// The start time of a process, in clock ticks since boot; empty if there is no such process. Ids are reused, pairs of id and start time
/// are not.
std::string beginOf(long pid) {
  const std::string line = firstLine(fmt::format("/proc/{}/stat", pid));
  const auto name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  std::string field, state;
  for (int number = 3; number <= 22 && fields >> field; ++number)
    if (number == 3) state = field;
  return state == "Z" || state == "X" ? std::string() : field;
}

std::string hostName() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The contents of a claim; empty if the file is not a claim.
struct Claim {
  std::string worker, machine, begin;
  long pid = 0;
};

std::optional<Claim> readClaim(const std::string& file) {
  try {
    const auto json = nlohmann::json::parse(readTextFile(file, claim_limit_bytes));
    return Claim{json.at("worker"), json.at("machine"), json.at("begin"), json.at("pid")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const BadFile&) {
    return std::nullopt;
  }
}

double modifiedS(const std::string& file, int& reason) {
  struct stat status {};
  reason = stat(file.c_str(), &status) == 0 ? 0 : errno;
  return static_cast<double>(status.st_mtim.tv_sec) + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

}  // namespace

Claims::Claims(const std::string& folder, double stale_after_s) : folder_(folder), machine_(thisMachine()), stale_after_s_(stale_after_s) {
  const std::string begin = beginOf(getpid());
  // Containers on one machine may have equal host names and process ids.
  worker_ = fmt::format("{}-{}-{}", hostName(), getpid(), uniqueName());
  text_ = nlohmann::json{{"worker", worker_}, {"host", hostName()}, {"machine", machine_}, {"pid", getpid()}, {"begin", begin}}.dump();
  replaceFile(folder_ + "/workers/" + worker_, text_);
  beat();
}

Claims::~Claims() {
  unlink((folder_ + "/workers/" + worker_).c_str());
}

std::string Claims::path(std::size_t row, int attempt) const {
  return fmt::format("{}/claims/{}.{}", folder_, rowName(row), attempt);
}

void Claims::beat() {
  const double now_s = steadySeconds();
  if (now_s - last_beat_s_ < stale_after_s_ / 10) return;
  last_beat_s_ = now_s;
  const std::string file = folder_ + "/workers/" + worker_;
  if (utimensat(AT_FDCWD, file.c_str(), nullptr, 0) == 0) return;
  if (errno != ENOENT) throw IoError(fmt::format("{}: cannot be touched: {}", file, std::strerror(errno)));
  replaceFile(file, text_);
}

bool Claims::claim(std::size_t row, int attempt) {
  const std::string file = path(row, attempt);
  if (access(file.c_str(), F_OK) == 0) return false;
  const bool mine = FileReplacement(file, text_).commitIfAbsent();
  if (mine) syncFolder(folder_ + "/claims");
  return mine;
}

void Claims::end(std::size_t row, int attempt, AttemptEnd how, const std::string& message) {
  const nlohmann::json json = {{"end", end_names[static_cast<std::size_t>(how)]}, {"message", message}};
  replaceFile(path(row, attempt) + ".end", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

RowHistory Claims::history(std::size_t row) const {
  RowHistory history;
  for (int attempt = 1; access(path(row, attempt).c_str(), F_OK) == 0; ++attempt) {
    history.attempt_count = attempt;
    history.free = true;
    if (access((path(row, attempt) + ".end").c_str(), F_OK) == 0) {
      addEnd(history, path(row, attempt) + ".end");
      continue;
    }
    // The worker that took over has checked that the previous worker was gone.
    const bool is_last = access(path(row, attempt + 1).c_str(), F_OK) != 0;
    history.free = !is_last || isGone(path(row, attempt));
    if (!history.free) return history;
    ++history.kill_count;
    history.message = readClaim(path(row, attempt)) ? "its worker vanished" : path(row, attempt) + ": is unreadable; its worker vanished";
  }
  return history;
}

void Claims::addEnd(RowHistory& history, const std::string& end_file) {
  const auto json = nlohmann::json::parse(readTextFile(end_file, claim_limit_bytes), nullptr, false);
  if (!json.is_object() || !json.contains("end")) throw BadFile(end_file, "is not the end of an attempt");
  history.crash_count += json["end"] == end_names[0];
  history.kill_count += json["end"] == end_names[1];
  if (json["end"] != end_names[2]) history.message = json.value("message", "");
}

bool Claims::isGone(const std::string& claim_file) const {
  const auto claim = readClaim(claim_file);
  // A power failure may leave an empty claim; a network file system may show a new claim as empty for a moment.
  if (!claim) return ageS(claim_file) > stale_after_s_;
  if (claim->worker == worker_) return false;
  if (claim->machine == machine_) return beginOf(claim->pid) != claim->begin;
  return ageS(folder_ + "/workers/" + claim->worker) > stale_after_s_;
}

double Claims::ageS(const std::string& file) const {
  int reason = 0;
  const double then_s = modifiedS(file, reason);
  if (reason == ENOENT) return 1e300;  // it has ended
  const double now_s = modifiedS(folder_ + "/workers/" + worker_, reason);
  if (reason != 0) throw IoError(fmt::format("{}/workers: cannot be read: {}", folder_, std::strerror(reason)));
  // This worker's own heartbeat may be as old as its interval between heartbeats.
  return now_s - then_s;
}

std::vector<bool> Claims::tried(std::size_t row_count) const {
  std::vector<bool> tried(row_count, false);
  for (const auto& entry : fs::directory_iterator(folder_ + "/claims")) {
    const std::string name = entry.path().filename().string();
    std::size_t row = 0;
    const auto result = std::from_chars(name.data(), name.data() + name.size(), row);
    if (result.ec == std::errc() && *result.ptr == '.' && row < row_count) tried[row] = true;
  }
  return tried;
}

}  // namespace musclesim
