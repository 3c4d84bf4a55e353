#include "base/program_in_path.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "musclesim/base/file.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

class ProgramInPath : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"folder", "text", "program", "later"}) fs::create_directories(home_ / name);
    fs::create_directories(home_ / "folder/tool");
    for (const char* name : {"text/tool", "program/tool", "later/tool"}) replaceFile((home_ / name).string(), "");
    for (const char* name : {"program/tool", "later/tool"}) fs::permissions(home_ / name, fs::perms::owner_all);
    fs::current_path(home_ / "later");
  }
  void TearDown() override {
    setenv("PATH", before_.c_str(), 1);
    fs::current_path(begun_in_);
    fs::remove_all(home_);
  }
  fs::path found(const std::string& path) const {
    setenv("PATH", path.c_str(), 1);
    return programInPath("tool");
  }
  const fs::path begun_in_ = fs::current_path();
  const fs::path home_ = fs::temp_directory_path() / ("musclesim_path_test_" + std::to_string(getpid()));
  const std::string before_ = std::getenv("PATH");
};

TEST_F(ProgramInPath, IsTheFirstFileThatCanBeRun) {
  const std::string home = home_.string();
  EXPECT_EQ(found(home + "/folder:" + home + "/text:" + home + "/program:" + home + "/later"), home_ / "program/tool");
  EXPECT_EQ(found(home + "/folder:" + home + "/text"), "");
  EXPECT_EQ(found(""), "");
}

TEST_F(ProgramInPath, IsNotTakenFromTheFolderOneWorksIn) {
  for (const char* path : {".", ":/nonexistent", "/nonexistent::", "../later", "../program:."}) EXPECT_EQ(found(path), "") << path;
}

}  // namespace
}  // namespace musclesim
