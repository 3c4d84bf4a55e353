#include "musclesim/log/recorder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "row_text.h"
#include "sidecar.h"

namespace musclesim {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int largest_unwritten_rows = 256;
constexpr std::chrono::seconds longest_unwritten{1};

}  // namespace

/// Looks at the sidecar, because the table of a killed run may be incomplete.
void requireReplaceable(const std::string& csv) {
  namespace fs = std::filesystem;
  const std::string sidecar = sidecarPath(csv);
  if (!fs::exists(csv) && !fs::exists(sidecar)) return;
  std::ifstream text(sidecar);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const bool is_recording = json.is_object() && json.value("format", nlohmann::json()).dump().starts_with("\"musclesim-recording");
  const auto program = is_recording ? json.find("program") : json.end();
  if (program != json.end() && program->is_string() && program->get<std::string>().starts_with("musclesim ")) return;
  if (!fs::exists(csv) && !is_recording)
    throw BadParameter(fmt::format("{} would be written over with the sidecar of {}: choose another name", sidecar, csv));
  throw BadParameter(fmt::format("{} exists and {}: choose another name, or remove it", fs::exists(csv) ? csv : sidecar,
                                 is_recording ? "belongs to a recording that musclesim did not simulate" : "belongs to no recording"));
}

/// The open CSV file, the rows not yet written, and the sidecar for close().
struct Recorder::Implementation {
  Implementation(const std::string& file, RecordingInfo sidecar, std::vector<std::string> columns)
      : csv_file(file), info(std::move(sidecar)), rows(std::move(columns)) {
    if (std::filesystem::path(file).extension() != ".csv") throw BadParameter("recording file", file, "end in .csv");
    info.complete = false;
    replaceFile(sidecarPath(csv_file), sidecarText(info, sidecarPath(csv_file)));
    descriptor = open(csv_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) fail("opened for writing");
    unwritten = rows.header();
    try {
      flush();
    } catch (...) {
      ::close(descriptor);
      throw;
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    const int reason = errno;
    throw IoError(fmt::format("{}: cannot be {}: {}", csv_file, what, std::strerror(reason)));
  }

  void flush() {
    const std::size_t written = writeAll(descriptor, unwritten);
    const int reason = errno;
    const bool done = written == unwritten.size();
    unwritten.erase(0, written);
    errno = reason;
    if (!done) fail("written");
    unwritten_rows = 0;
    last_flush = Clock::now();
  }

  void flushIfDue() {
    if (unwritten_rows >= largest_unwritten_rows || Clock::now() - last_flush >= longest_unwritten) flush();
  }

  void closeFile() {
    flush();
    const int synced = fsync(descriptor);
    // A device or pipe cannot be synced; a file on a disk can.
    if (synced != 0 && errno != EINVAL && errno != EROFS) fail("written to the disk");
    const int closed = ::close(descriptor);
    descriptor = -1;
    if (closed != 0) fail("closed");
  }

  void requireOpen() const {
    if (descriptor < 0) throw BadParameter(csv_file + ": the recorder is closed already");
  }

  std::string csv_file;
  RecordingInfo info;
  RowText rows;
  int descriptor = -1;
  std::string unwritten;
  int unwritten_rows = 0;
  Clock::time_point last_flush = Clock::now();
};

Recorder::Recorder(const std::string& csv_file, RecordingInfo info, std::vector<std::string> columns)
    : implementation_(std::make_unique<Implementation>(csv_file, std::move(info), std::move(columns))), csv_file_(csv_file) {}

Recorder::~Recorder() {
  try {
    close(false);
  } catch (...) {
    // A destructor cannot report the error; the sidecar on the disk still says "complete": false.
  }
  if (implementation_->descriptor >= 0) ::close(implementation_->descriptor);
}

void Recorder::append(double time_s, const std::vector<double>& values) {
  implementation_->requireOpen();
  implementation_->rows.append(implementation_->unwritten, time_s, values);
  ++implementation_->unwritten_rows;
  ++row_count_;
  implementation_->flushIfDue();
}

void Recorder::note(const std::string& member, const std::string& json_value) {
  implementation_->requireOpen();
  if (member == "complete" || member == "format") throw BadParameter("sidecar member", member, "be set by the recorder alone");
  implementation_->info = withMember(implementation_->info, member, json_value);
}

void Recorder::close(bool complete) {
  if (implementation_->descriptor < 0) return;
  implementation_->closeFile();
  implementation_->info.complete = complete;
  replaceFile(sidecarPath(csv_file_), sidecarText(implementation_->info, sidecarPath(csv_file_)));
}

}  // namespace musclesim
