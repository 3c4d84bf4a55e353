/// Results on the disk by key, for work that may be killed at any time and goes on later.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace musclesim {

/// A file that only grows. A first line names what the records depend on; then come records: lengths, a checksum, key and value. What a
/// killed process wrote in part, and what was damaged later, is dropped together with all that follows it. Thread-safe.
///
/// If the disk refuses a record, for example because it is full, the file is removed, so that the results proper find room; `trouble()`
/// then has the reason, and nothing is kept any more.
class RecordFile {
 public:
  static constexpr std::size_t usual_limit_bytes = std::size_t{1} << 30;  ///< some ten thousand simulations

  /// Opens the file, or creates it. Throws IoError, also if another process has it open. `limit_bytes`: what would make the file larger is
  /// not kept.
  explicit RecordFile(std::string file, std::size_t limit_bytes = usual_limit_bytes);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// What the records in the file depend on, as begin() was told; empty if the file holds no whole first line.
  const std::string& origin() const { return origin_; }
  /// Empties the file and begins anew. `origin`: one line of text. Throws IoError.
  void begin(const std::string& origin);
  /// Reads the file, so that find() knows its records, and cuts off the first incomplete record and all after it. Returns the number of
  /// records. Throws IoError.
  std::size_t resume();

  /// The value of a key; none if it is not in the file.
  std::optional<std::string> find(const std::string& key) const;
  /// Appends a record.
  void add(const std::string& key, std::string_view value);

  /// Bytes that resume() dropped.
  std::size_t droppedBytes() const { return dropped_bytes_; }
  std::size_t sizeBytes() const { return end_; }
  /// Why nothing is kept any more; empty if all is well.
  std::string trouble() const;
  /// Removes the file.
  void remove();

 private:
  struct Place {
    std::size_t first, count;
  };
  std::optional<std::string> bytesAt(std::size_t first, std::size_t count) const;
  void readOrigin();
  bool readRecord(std::size_t file_bytes);
  void giveUp(const std::string& why);

  const std::string file_;
  const std::size_t limit_bytes_;
  int descriptor_ = -1;
  std::string origin_, trouble_;
  std::size_t end_ = 0, dropped_bytes_ = 0;
  std::map<std::string, Place> places_;  ///< of the values
  mutable std::mutex access_;
};

}  // namespace musclesim
