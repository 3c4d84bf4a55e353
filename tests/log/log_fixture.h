/// Helpers of the tests in this folder: a temporary folder, a valid recording, and checks of thrown errors.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/log/recording.h"
#include "support/support.h"

namespace musclesim {

/// A folder that is removed after the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "musclesim-XXXXXX").string();
    if (!mkdtemp(name.data())) throw IoError(name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::size_t fileCount() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

inline void writeText(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string readText(const std::string& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

inline const std::string minimal_sidecar = R"({"format": "musclesim-recording-1", "robot": "rig"})";

inline Recording parseCsv(const std::string& csv, const std::string& json = minimal_sidecar, const ReadOptions& options = {}) {
  return parseRecording(csv, "run.csv", json, "run.json", options);
}

/// Whether the message contains all of the words.
inline testing::AssertionResult hasWords(const std::string& message, const std::vector<std::string>& words) {
  for (const auto& word : words)
    if (message.find(word) == std::string::npos) return testing::AssertionFailure() << "\"" << message << "\" lacks \"" << word << "\"";
  return testing::AssertionSuccess();
}

}  // namespace musclesim
