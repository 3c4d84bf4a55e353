/// Whole files: reads with a size limit; replaces atomically, so that a reader finds the old file or the new one, never a part.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace musclesim {

/// The contents of a file. Throws IoError if it does not exist or cannot be read, BadFile if it is larger than `limit_bytes`.
std::string readTextFile(const std::string& file, std::size_t limit_bytes);

/// Whether a path, relative to a folder, is that of something within the folder; a link that leads elsewhere is not. What does not exist is
/// judged by its name. For names in files that may come from anywhere.
bool isWithin(const std::string& folder, const std::string& path);

/// A new version of a file, under a temporary name in the same folder. commit() puts it in place; the destructor removes it if it was not
/// committed. Throws IoError with the file's name and the system's reason.
class FileReplacement {
 public:
  /// Writes `text` to the temporary file and to the disk (fsync).
  FileReplacement(std::string file, std::string_view text);
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  /// Renames the temporary file to its final name.
  void commit();
  /// As commit(), but only if no file of that name exists yet. If several processes try at once, on one or many machines, one succeeds.
  /// Returns whether this call succeeded.
  bool commitIfAbsent();

 private:
  std::string file_, temporary_file_;
  bool committed_ = false;
};

/// Replaces or creates `file`. Throws IoError.
void replaceFile(const std::string& file, std::string_view text);

/// Waits until the disk has all entries of a folder (fsync). Throws IoError.
void syncFolder(const std::string& folder);

/// Writes all bytes to an open file descriptor. Returns how many bytes were written; if fewer than given, errno holds the reason.
std::size_t writeAll(int descriptor, std::string_view bytes);

}  // namespace musclesim
