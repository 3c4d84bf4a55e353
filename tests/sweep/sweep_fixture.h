/// Helpers of the tests of sweeps: a folder, small sweeps, and programs that misbehave.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/support.h"
#include "sweep/sweep.h"

namespace musclesim {

namespace fs = std::filesystem;

inline std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline void writeFile(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

/// An empty folder that is removed at the end.
class SweepTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("musclesim_sweep_test_" + std::to_string(getpid()) + "_" + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A sweep of `count` rows in the folder `name`, with the row's number as parameter x.
  std::string sweepOf(std::size_t count, const std::string& name = "sweep", const std::vector<std::string>& command = {"{x}", "{out}"}) {
    Sweep sweep;
    sweep.command = command;
    for (std::size_t i = 0; i < count; ++i) sweep.rows.push_back({{{"x", static_cast<double>(i)}}, {}});
    writeSweep(sweep, path(name));
    return path(name);
  }

  /// A shell script to be run in place of musclesim; $1 is the row's x, $2 its folder.
  std::string script(const std::string& text) {
    const std::string file = path("program.sh");
    writeFile(file, "#!/bin/sh\n" + text + "\n");
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }

  fs::path folder_;
};

}  // namespace musclesim
