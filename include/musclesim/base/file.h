/// Whole files: reading with a limit, and replacing so that a reader finds the old file or the new one and never a part.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace musclesim {

/// The contents of a file. Throws IoError if it does not exist or cannot be read, BadFile if it is larger than `limit_bytes`.
std::string readTextFile(const std::string& file, std::size_t limit_bytes);

/// A new version of a file under a temporary name in the same folder; commit() puts it in place, the destructor removes it if that never
/// happened. Throws IoError naming the file and the system's reason.
class FileReplacement {
 public:
  /// Writes `text` to the temporary file and to the disk (fsync).
  FileReplacement(std::string file, std::string_view text);
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  /// Renames the temporary file to its final name.
  void commit();
  /// The same, but only if there is no file of that name yet; of several that try at once, on one or many machines, one succeeds.
  /// Returns whether this one did.
  bool commitIfAbsent();

 private:
  std::string file_, temporary_file_;
  bool committed_ = false;
};

/// Replaces or creates `file`. Throws IoError.
void replaceFile(const std::string& file, std::string_view text);

/// Waits until a folder's entries are on the disk. Throws IoError.
void syncFolder(const std::string& folder);

/// Writes all bytes to an open file descriptor. Returns how many reached the file; fewer than given means failure, with the reason in
/// errno.
std::size_t writeAll(int descriptor, std::string_view bytes);

}  // namespace musclesim
