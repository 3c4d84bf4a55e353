#include "musclesim/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "musclesim/base/error.h"
#include "musclesim/base/unique_name.h"

namespace musclesim {

namespace {

[[noreturn]] void failed(const std::string& file, const std::string& what, int reason) {
  throw IoError(fmt::format("{}: cannot be {}: {}", file, what, std::strerror(reason)));
}

/// Creates FILE.xxxx.tmp with a name that is unique, also across machines; returns its descriptor.
int createTemporary(const std::string& file, std::string& temporary_file) {
  constexpr int most_tries = 10;
  int descriptor = -1;
  for (int i = 0; i < most_tries; ++i) {
    temporary_file = fmt::format("{}.{}.tmp", file, uniqueName());
    descriptor = open(temporary_file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) break;
  }
  if (descriptor < 0) failed(file, "opened for writing", errno);
  return descriptor;
}

}  // namespace

std::string readTextFile(const std::string& file, std::size_t limit_bytes) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) failed(file, "opened for reading", errno);
  const auto close_at_end = [](const int* opened) { close(*opened); };
  const std::unique_ptr<const int, decltype(close_at_end)> closer(&descriptor, close_at_end);
  struct stat status {};
  if (fstat(descriptor, &status) != 0) failed(file, "read", errno);
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) throw BadFile(file, "is a device: must be a file or a pipe");
  const auto refuseSize = [&] { throw BadFile(file, fmt::format("is larger than the {} MiB that are allowed", limit_bytes >> 20)); };
  if (S_ISREG(status.st_mode) && status.st_size > static_cast<off_t>(limit_bytes)) refuseSize();
  std::string text;
  if (S_ISREG(status.st_mode)) text.reserve(static_cast<std::size_t>(status.st_size));
  std::string block(std::size_t{1} << 16, '\0');
  while (true) {
    const ssize_t count = read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failed(file, "read", errno);
    if (count == 0) return text;
    text.append(block, 0, static_cast<std::size_t>(count));
    if (text.size() > limit_bytes) refuseSize();
  }
}

bool isWithin(const std::string& folder, const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path normal = fs::path(path).lexically_normal();
  if (normal.is_absolute() || normal.empty() || *normal.begin() == "..") return false;
  std::error_code ignored;
  const fs::path base = fs::weakly_canonical(folder.empty() ? "." : folder, ignored), file = fs::weakly_canonical(base / normal, ignored);
  return std::ranges::mismatch(base, file).in1 == base.end();
}

std::size_t writeAll(int descriptor, std::string_view bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = write(descriptor, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) errno = ENOSPC;
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  return written;
}

FileReplacement::FileReplacement(std::string file, std::string_view text) : file_(std::move(file)) {
  const int descriptor = createTemporary(file_, temporary_file_);
  int reason = 0;
  if (writeAll(descriptor, text) != text.size() || fsync(descriptor) != 0) reason = errno;
  if (close(descriptor) != 0 && reason == 0) reason = errno;
  if (reason == 0) return;
  unlink(temporary_file_.c_str());
  failed(file_, "written", reason);
}

FileReplacement::~FileReplacement() {
  if (!committed_) unlink(temporary_file_.c_str());
}

void FileReplacement::commit() {
  if (rename(temporary_file_.c_str(), file_.c_str()) != 0) failed(file_, "replaced", errno);
  committed_ = true;
}

bool FileReplacement::commitIfAbsent() {
  const int linked = link(temporary_file_.c_str(), file_.c_str());
  const int reason = errno;
  struct stat status {};
  // A network file system may make the link but lose the answer; then the file has two names.
  const bool absent = linked == 0 || (stat(temporary_file_.c_str(), &status) == 0 && status.st_nlink == 2);
  if (!absent && reason != EEXIST) failed(file_, "created", reason);
  return absent;
}

void syncFolder(const std::string& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 && errno == EACCES) return;  // the folder may be writable but not readable
  if (descriptor < 0) failed(folder, "opened", errno);
  const int synced = fsync(descriptor), reason = errno;
  close(descriptor);
  if (synced != 0 && reason != EINVAL) failed(folder, "written to the disk", reason);  // EINVAL: this file system needs no sync
}

void replaceFile(const std::string& file, std::string_view text) {
  FileReplacement(file, text).commit();
}

}  // namespace musclesim
