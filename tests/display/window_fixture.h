/// The program in a window of an X server of the tests' own.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "display/session.h"
#include "musclesim/log/recording.h"
#include "simulation/scene/camera.h"
#include "simulation/scene/image.h"

namespace musclesim {

namespace fs = std::filesystem;
using nlohmann::json;

inline std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline Image readPng(const fs::path& file) {
  png_image description = {};
  description.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&description, file.c_str())) throw std::runtime_error(file.string() + ": " + description.message);
  description.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(description.width), static_cast<int>(description.height),
              std::vector<std::uint8_t>(PNG_IMAGE_SIZE(description))};
  png_image_finish_read(&description, nullptr, image.rgb.data(), 0, nullptr);
  return image;
}

inline double differingShare(const Image& a, const Image& b) {
  long differing = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) differing += std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24;
  return 3.0 * static_cast<double>(differing) / static_cast<double>(a.rgb.size());
}

inline Camera cameraOf(const json& state) {
  const json& camera = state["camera"];
  const Eigen::Vector3f center_mm(camera["center_mm"][0], camera["center_mm"][1], camera["center_mm"][2]);
  return {center_mm, camera["azimuth_deg"], camera["elevation_deg"], camera["distance_mm"]};
}

/// One X server for all tests, a fresh folder for each.
class WindowTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (XServer::missing().empty()) server_ = new XServer;
  }
  static void TearDownTestSuite() {
    delete server_;
    server_ = nullptr;
  }
  void SetUp() override {
    if (!server_) GTEST_SKIP() << XServer::missing();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  json sidecar() const { return json::parse(contentOf(folder_ / "run" / "run.json")); }

  /// Takes a picture with the key s.
  Image picture(Session& session) {
    const fs::path file = folder_ / "run" / ("window-" + std::to_string(++picture_count_) + ".png");
    session.press("s");
    for (int i = 0; i < 1000 && !fs::exists(file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return readPng(file);
  }

  static inline XServer* server_ = nullptr;
  const fs::path folder_ = fs::temp_directory_path() / ("musclesim_window_test_" + std::to_string(getpid()));
  int picture_count_ = 0;
};

inline const std::vector<std::string> small_arm = {"--picture-size", "640x480"};

}  // namespace musclesim
