#include "simulation/scene/video.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "musclesim/base/error.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

Image plain(int width, int height, std::uint8_t grey) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3, grey)};
}

/// An empty folder, removed at the end; and a PATH that can be changed.
class Video : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = std::getenv("PATH");
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }
  bool hasFfmpeg() const { return std::system("command -v ffmpeg >/dev/null 2>&1") == 0; }
  void installProgram(const std::string& text) {
    std::ofstream(folder_ / "ffmpeg") << "#!/bin/sh\n" << text;
    fs::permissions(folder_ / "ffmpeg", fs::perms::owner_all);
    setenv("PATH", (folder_.string() + ":/usr/bin:/bin").c_str(), 1);
  }

  const fs::path folder_ = fs::temp_directory_path() / ("musclesim video test " + std::to_string(getpid()));
  std::string path_;
};

TEST_F(Video, MakesAFileWithFfmpeg) {
  if (!hasFfmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  const fs::path file = folder_ / "a video; with $(signs).mp4";
  VideoWriter video(file.string(), 65, 49, 30);
  for (int i = 0; i < 30; ++i) video.add(plain(65, 49, static_cast<std::uint8_t>(8 * i)));
  video.close();
  EXPECT_EQ(video.frameCount(), 30);
  EXPECT_EQ(video.result(), file.string());
  EXPECT_GT(fs::file_size(file), 500u);
}

TEST_F(Video, LeavesPicturesWithoutFfmpeg) {
  setenv("PATH", folder_.c_str(), 1);
  VideoWriter video((folder_ / "v.mp4").string(), 40, 30, 30);
  for (int i = 0; i < 3; ++i) video.add(plain(40, 30, 100));
  video.close();
  EXPECT_EQ(video.result(), (folder_ / "v-frames").string());
  EXPECT_TRUE(fs::exists(folder_ / "v-frames" / "000003.png"));
  EXPECT_FALSE(fs::exists(folder_ / "v.mp4"));
}

TEST_F(Video, SaysWhenFfmpegFails) {
  installProgram("exit 3\n");
  VideoWriter video((folder_ / "v.mp4").string(), 40, 30, 30);
  EXPECT_THROW(
      {
        for (int i = 0; i < 1000; ++i) video.add(plain(40, 30, 100));
        video.close();
      },
      IoError);
}

TEST_F(Video, RefusesOtherNamesFoldersAndSizes) {
  EXPECT_THROW(VideoWriter((folder_ / "v.avi").string(), 40, 30, 30), BadParameter);
  EXPECT_THROW(VideoWriter((folder_ / "absent" / "v.mp4").string(), 40, 30, 30), IoError);
  VideoWriter video((folder_ / "v.mp4").string(), 40, 30, 30);
  EXPECT_THROW(video.add(plain(41, 30, 0)), BadParameter);
}

}  // namespace
}  // namespace musclesim
