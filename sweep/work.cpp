#include "work.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "claims.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/hash.h"
#include "musclesim/version.h"
#include "result.h"
#include "robots_hash.h"
#include "sweep.h"

namespace musclesim {

namespace fs = std::filesystem;

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t output_limit_bytes = std::size_t{64} << 20;
constexpr int most_crashes = 2, most_kills = 5;
constexpr std::chrono::milliseconds longest_wait(1000);
constexpr std::chrono::milliseconds interrupt_delay(300);  ///< a signal that ends a run reaches its worker within this time, if both get it
constexpr double end_margin_s = 1.0;                       ///< time that a worker needs to give a row back

/// Exit statuses of the program, which give the status of a row; see docs/user/getting_started.md.
enum Status { done = 0, bad_usage = 2, bad_input = 3, diverged = 4 };

void requireSameModel(const Sweep& sweep, const std::string& folder) {
  const std::string file = folder + "/manifest.json", program = "musclesim " MUSCLESIM_VERSION;
  if (sweep.program != program) throw BadFile(file, fmt::format("was planned by {}; this is {}", sweep.program, program));
  if (sweep.robots_hash != robotsHash()) throw BadFile(file, "was planned with other robots than this program has");
  for (const auto& [path, expected] : sweep.inputs) {
    Hash hash;
    hash.add(readTextFile(folder + "/" + path, std::size_t{512} << 20));
    if (hash.text() != expected) throw BadFile(folder + "/" + path, "has changed since the sweep was planned");
  }
}

/// Renames the folder of a finished attempt to its final name. If an earlier attempt did that before it was killed, its folder is kept.
void moveInPlace(const std::string& from, const std::string& to) {
  syncFolder(from);
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    if (errno != ENOTEMPTY && errno != EEXIST) throw IoError(fmt::format("{}: cannot be renamed: {}", from, std::strerror(errno)));
    fs::remove_all(from);
  }
  syncFolder(fs::path(to).parent_path().string());
}

class Worker {
 public:
  Worker(const std::string& folder, const WorkOptions& options)
      : folder_(folder), options_(options), sweep_(readSweep(folder)), claims_(folder, options.stale_after_s) {
    requireSameModel(sweep_, folder_);
    tried_ = claims_.tried(sweep_.rows.size());
  }

  WorkSummary run() {
    while (!mustStop() && workOnNext()) {
    }
    summary_.wall_s = elapsedS();
    return summary_;
  }

 private:
  double elapsedS() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  bool mustStop() {
    if (options_.interrupt_signal() != 0)
      summary_.end = WorkSummary::End::interrupted;
    else if (elapsedS() + longest_row_s_ + end_margin_s > options_.time_limit_s)
      summary_.end = WorkSummary::End::time_limit;
    else
      return false;
    return true;
  }

  /// Works on a new row, or on one that another worker left. Returns false if no row is left to wait for.
  bool workOnNext() {
    while (next_ < sweep_.rows.size()) {
      if (tried_[next_]) {
        ++next_;
        continue;
      }
      const std::size_t row = next_++;
      if (claims_.claim(row, 1)) {
        makeAttempt(row, 1);
        return true;
      }
      tried_ = claims_.tried(sweep_.rows.size());
    }
    return takeOverOrWait();
  }

  bool takeOverOrWait() {
    bool others_are_at_work = false;
    for (std::size_t row = first_open_; row < sweep_.rows.size(); ++row) {
      if (hasResult(folder_, row)) {
        if (row == first_open_) ++first_open_;
        continue;
      }
      const RowHistory history = claims_.history(row);
      if (history.free && claims_.claim(row, history.attempt_count + 1)) {
        if (!history.message.empty()) options_.say(fmt::format("row {}: taken over: {}", row, history.message));
        makeAttempt(row, history.attempt_count + 1);
        return true;
      }
      others_are_at_work = true;
    }
    if (!others_are_at_work || !options_.wait) return false;
    claims_.beat();
    std::this_thread::sleep_for(wait_);
    wait_ = std::min(2 * wait_, longest_wait);
    return true;
  }

  /// Runs a row that this worker has claimed, and repeats it if it crashes.
  void makeAttempt(std::size_t row, int attempt) {
    for (;; ++attempt) {
      if (hasResult(folder_, row)) return;  // a worker that was believed dead has finished it
      const RowHistory before = attempt == 1 ? RowHistory() : claims_.history(row);
      if (before.crash_count >= most_crashes || before.kill_count >= most_kills) return giveUp(row, attempt, before);
      if (runOnce(row, attempt)) return;
      if (mustStop() || !claims_.claim(row, attempt + 1)) return;
    }
  }

  void giveUp(std::size_t row, int attempt, const RowHistory& history) {
    RowResult result;
    result.status = "crashed";
    result.exit_status = 1;
    result.message = history.message;
    result.attempt_count = attempt - 1;
    conclude(row, result);
  }

  /// True if the row needs no further attempt by this worker.
  bool runOnce(std::size_t row, int attempt) {
    const std::string out = fmt::format("outputs/{}.{}.{}.tmp", rowName(row), attempt, getpid());
    fs::remove_all(folder_ + "/" + out);
    fs::create_directories(folder_ + "/" + out);
    const std::string absolute_out = fs::absolute(folder_ + "/" + out).string();
    const ChildCommand command{options_.program, argumentsOf(sweep_, row, out), folder_, absolute_out + "/stdout.txt",
                               absolute_out + "/stderr.txt"};
    const double begin_s = elapsedS();
    bool out_of_time = false, stop = false;
    const ChildEnd end = runChild(command, [&] {
      claims_.beat();
      stop = options_.interrupt_signal() != 0 || elapsedS() + end_margin_s > options_.time_limit_s;
      out_of_time = sweep_.row_time_limit_s > 0 && elapsedS() - begin_s > sweep_.row_time_limit_s;
      return stop || out_of_time;
    });
    longest_row_s_ = std::max(longest_row_s_, end.wall_s);
    summary_.child_wall_s += end.wall_s;
    const std::string last_words = errorLine(readTextFile(absolute_out + "/stderr.txt", output_limit_bytes));
    if (const auto without = withoutResult(end, stop, out_of_time, last_words)) {
      fs::remove_all(absolute_out);
      claims_.end(row, attempt, without->first, without->second);
      if (without->first != AttemptEnd::abandoned) options_.say(fmt::format("row {}: {} (attempt {})", row, without->second, attempt));
      return without->first == AttemptEnd::abandoned;
    }
    finish(row, attempt, end, command, absolute_out, last_words);
    return true;
  }

  bool isInterruptedSoon() const {
    for (auto waited = 0ms; waited < interrupt_delay; waited += 10ms) {
      if (options_.interrupt_signal() != 0) return true;
      std::this_thread::sleep_for(10ms);
    }
    return options_.interrupt_signal() != 0;
  }

  /// The reason why an attempt has no result; empty if it has one.
  std::optional<std::pair<AttemptEnd, std::string>> withoutResult(const ChildEnd& end, bool stop, bool out_of_time,
                                                                  const std::string& last_words) const {
    if (end.stopped && stop) return {{AttemptEnd::abandoned, "its worker had to stop"}};
    if (end.stopped && out_of_time) return {{AttemptEnd::crashed, fmt::format("took longer than {} s", sweep_.row_time_limit_s)}};
    const int signal = end.signal != 0 ? end.signal : end.exit_status > 128 ? end.exit_status - 128 : 0;
    const bool from_outside = signal == SIGKILL || signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
    // A batch system signals both the run and its worker, in any order.
    if (from_outside && signal != SIGKILL && isInterruptedSoon()) return {{AttemptEnd::abandoned, "its worker had to stop"}};
    if (signal != 0)
      return {{from_outside ? AttemptEnd::killed : AttemptEnd::crashed, fmt::format("ended by signal {} ({})", signal, strsignal(signal))}};
    for (const int final : {done, bad_usage, bad_input, diverged})
      if (end.exit_status == final) return std::nullopt;
    return {{AttemptEnd::crashed, fmt::format("exit status {}: {}", end.exit_status, last_words)}};
  }

  void finish(std::size_t row, int attempt, const ChildEnd& end, const ChildCommand& command, const std::string& out,
              const std::string& last_words) {
    RowResult result;
    result.status = end.exit_status == done ? "done" : end.exit_status == diverged ? "diverged" : "failed";
    result.exit_status = end.exit_status;
    result.attempt_count = attempt;
    result.wall_s = end.wall_s;
    if (end.exit_status != done) result.message = last_words;
    readNumbers(out, command.arguments, result);
    for (const char* name : {"/stdout.txt", "/stderr.txt"})
      if (fs::file_size(out + name) == 0) fs::remove(out + name);
    moveInPlace(out, folder_ + "/outputs/" + rowName(row));
    namePlace(fs::path(out).filename().string(), rowName(row), result);
    conclude(row, result);
  }

  /// Gives paths among the results the folder's final name.
  static void namePlace(const std::string& before, const std::string& name, RowResult& result) {
    for (auto& [key, value] : result.numbers.items()) {
      if (!value.is_string()) continue;
      std::string text = value.get<std::string>();
      if (const std::size_t at = text.find(before); at != std::string::npos) value = text.replace(at, before.size(), name);
    }
  }

  /// True if the plan names numbers to collect, or the command tells the run to print numbers.
  bool expectsNumbers(const std::vector<std::string>& arguments) const {
    return !sweep_.columns.empty() || !sweep_.result_file.empty() || std::ranges::find(arguments, "--json") != arguments.end();
  }

  void readNumbers(const std::string& out, const std::vector<std::string>& arguments, RowResult& result) const {
    const bool from_file = !sweep_.result_file.empty();
    if (from_file && !fs::exists(out + "/" + sweep_.result_file)) {
      if (result.status == "done") throwAway(result, fmt::format("{{out}}/{} was not written", sweep_.result_file));
      return;
    }
    const std::string text = readTextFile(out + "/" + (from_file ? sweep_.result_file : "stdout.txt"), output_limit_bytes);
    auto document = nlohmann::ordered_json::parse(from_file ? text : lastLine(text), nullptr, false);
    if (document.is_object())
      result.numbers = std::move(document);
    else if (from_file)
      throwAway(result, fmt::format("{{out}}/{} is not a JSON object", sweep_.result_file));
    if (result.status == "done" && result.numbers.empty() && expectsNumbers(arguments)) throwAway(result, "gave no numbers");
  }

  static void throwAway(RowResult& result, const std::string& why) {
    result.status = "failed";
    result.message = why;
  }

  void conclude(std::size_t row, RowResult& result) {
    result.worker = claims_.worker();
    if (!writeResult(folder_, row, result)) return;
    summary_.done_count += result.status == "done";
    summary_.diverged_count += result.status == "diverged";
    summary_.failed_count += result.status == "failed";
    summary_.crashed_count += result.status == "crashed";
    if (result.status != "done") options_.say(fmt::format("row {} {}: {}", row, result.status, result.message));
  }

  std::string folder_;
  const WorkOptions& options_;
  Clock::time_point begin_ = Clock::now();
  Sweep sweep_;
  Claims claims_;
  std::vector<bool> tried_;
  std::size_t next_ = 0, first_open_ = 0;
  double longest_row_s_ = 0;
  std::chrono::milliseconds wait_{10};  ///< time until it checks again whether other workers have finished or died
  WorkSummary summary_;
};

}  // namespace

WorkSummary work(const std::string& folder, const WorkOptions& options) {
  return Worker(folder, options).run();
}

}  // namespace musclesim
