#include "musclesim/base/record_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/hash.h"

namespace musclesim {

namespace {

constexpr std::string_view first_word = "musclesim-kept-1 ";
constexpr std::size_t hash_digits = 16, longest_origin_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_key_bytes = std::size_t{1} << 20;

/// Stands before key and value of a record, in the byte order of this machine.
struct RecordHead {
  std::uint64_t key_bytes, value_bytes, checksum;
};

std::uint64_t checksumOf(std::string_view key, std::string_view value) {
  Hash hash;
  hash.add(key);
  hash.add(value);
  return hash.value();
}

std::string hashOf(std::string_view text) {
  Hash hash;
  hash.add(text);
  return hash.text();
}

}  // namespace

RecordFile::RecordFile(std::string file, std::size_t limit_bytes) : file_(std::move(file)), limit_bytes_(limit_bytes) {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor_ < 0) throw IoError(fmt::format("{}: cannot be opened for writing: {}", file_, std::strerror(errno)));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {  // some network file systems have no locks
    close(descriptor_);
    throw IoError(fmt::format("{}: another process is at work here: wait for its end, or choose another folder", file_));
  }
  readOrigin();
}

RecordFile::~RecordFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void RecordFile::readOrigin() {
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) return;
  const auto file_bytes = static_cast<std::size_t>(status.st_size);
  const auto text = bytesAt(0, std::min(file_bytes, longest_origin_bytes));
  if (!text || !text->starts_with(first_word)) return;
  const std::size_t line_end = text->find('\n'), begin = first_word.size() + hash_digits + 1;
  if (line_end == std::string::npos || line_end < begin) return;
  const std::string origin = text->substr(begin, line_end - begin);
  if (text->substr(first_word.size(), hash_digits + 1) != hashOf(origin) + " ") return;
  origin_ = origin;
  end_ = line_end + 1;
}

void RecordFile::begin(const std::string& origin) {
  const std::lock_guard lock(access_);
  places_.clear();
  const std::string line = fmt::format("{}{} {}\n", first_word, hashOf(origin), origin);
  if (ftruncate(descriptor_, 0) != 0 || lseek(descriptor_, 0, SEEK_SET) != 0 || writeAll(descriptor_, line) != line.size())
    throw IoError(fmt::format("{}: cannot be written: {}", file_, std::strerror(errno)));
  origin_ = origin;
  end_ = line.size();
}

std::size_t RecordFile::resume() {
  const std::lock_guard lock(access_);
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) throw IoError(fmt::format("{}: cannot be read: {}", file_, std::strerror(errno)));
  const auto file_bytes = static_cast<std::size_t>(status.st_size);
  while (readRecord(file_bytes)) {
  }
  dropped_bytes_ = file_bytes - end_;
  if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0 || lseek(descriptor_, 0, SEEK_END) < 0)
    throw IoError(fmt::format("{}: cannot be written: {}", file_, std::strerror(errno)));
  return places_.size();
}

/// Reads the record at `end_`; returns false if there is no whole one.
bool RecordFile::readRecord(std::size_t file_bytes) {
  RecordHead head{};
  const auto head_bytes = bytesAt(end_, sizeof head);
  if (!head_bytes) return false;
  std::memcpy(&head, head_bytes->data(), sizeof head);
  const std::size_t left = file_bytes - end_ - sizeof head;
  if (head.key_bytes > longest_key_bytes || head.key_bytes > left || head.value_bytes > left - head.key_bytes) return false;
  const auto both = bytesAt(end_ + sizeof head, head.key_bytes + head.value_bytes);
  if (!both) return false;
  const std::string_view key = std::string_view(*both).substr(0, head.key_bytes), value = std::string_view(*both).substr(head.key_bytes);
  if (checksumOf(key, value) != head.checksum) return false;
  places_[std::string(key)] = {end_ + sizeof head + head.key_bytes, head.value_bytes};
  end_ += sizeof head + both->size();
  return true;
}

std::optional<std::string> RecordFile::bytesAt(std::size_t first, std::size_t count) const {
  std::string bytes(count, '\0');
  std::size_t done = 0;
  while (done < count) {
    const ssize_t read = pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(first + done));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return std::nullopt;
    done += static_cast<std::size_t>(read);
  }
  return bytes;
}

std::optional<std::string> RecordFile::find(const std::string& key) const {
  const std::lock_guard lock(access_);
  const auto place = places_.find(key);
  return place == places_.end() ? std::nullopt : bytesAt(place->second.first, place->second.count);
}

void RecordFile::add(const std::string& key, std::string_view value) {
  const RecordHead head = {key.size(), value.size(), checksumOf(key, value)};
  std::string bytes(reinterpret_cast<const char*>(&head), sizeof head);
  bytes += key;
  bytes += value;
  const std::lock_guard lock(access_);
  if (descriptor_ < 0 || end_ + bytes.size() > limit_bytes_ || places_.contains(key)) return;
  if (writeAll(descriptor_, bytes) != bytes.size()) {
    giveUp(std::strerror(errno));
    return;
  }
  places_[key] = {end_ + sizeof head + key.size(), value.size()};
  end_ += bytes.size();
}

void RecordFile::giveUp(const std::string& why) {
  trouble_ = why;
  unlink(file_.c_str());
  close(descriptor_);
  descriptor_ = -1;
  places_.clear();
}

std::string RecordFile::trouble() const {
  const std::lock_guard lock(access_);
  return trouble_;
}

void RecordFile::remove() {
  const std::lock_guard lock(access_);
  if (descriptor_ >= 0) unlink(file_.c_str());
}

}  // namespace musclesim
