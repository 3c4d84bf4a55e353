/// Imports texts and looks into the TOML that results.
#pragma once

#include <gtest/gtest.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "import/import.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {

class ImportedRobotTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("musclesim_robot_import_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  void import(const std::string& text) { importFile(write("robot.xml", text)); }
  void importFile(const std::string& file) {
    robot_ = importRobot(file);
    document_ = toml::parse(robot_.toml);
  }
  /// The message with which a text is refused.
  std::string refusal(const std::string& text) {
    return messageOf<BadFile>([&] { import(text); });
  }

  /// The table of that name in an array of tables: find("body", "arm").
  toml::table find(const std::string& array, const std::string& name) const {
    if (const auto* entries = document_[array].as_array())
      for (const toml::node& entry : *entries)
        if ((*entry.as_table())["name"].value_or(std::string()) == name) return *entry.as_table();
    ADD_FAILURE() << "no " << array << " " << name << " in\n" << robot_.toml;
    return {};
  }
  std::size_t count(const std::string& array) const {
    const auto* entries = document_[array].as_array();
    return entries ? entries->size() : 0;
  }
  bool hasNote(const std::string& part) const {
    for (const std::string& note : robot_.notes)
      if (note.find(part) != std::string::npos) return true;
    return false;
  }

  static std::vector<double> numbers(const toml::table& table, const std::string& key) {
    std::vector<double> values;
    if (const auto* entries = table[key].as_array())
      for (const toml::node& entry : *entries) values.push_back(entry.value_or(0.0));
    return values;
  }
  static void expectNear(const toml::table& table, const std::string& key, const std::vector<double>& expected, double tolerance = 1e-6) {
    const std::vector<double> values = numbers(table, key);
    ASSERT_EQ(values.size(), expected.size()) << key;
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], tolerance) << key << " " << i;
  }
  static double number(const toml::table& table, const std::string& key) { return table[key].value_or(0.0); }
  static std::string text(const toml::table& table, const std::string& key) { return table[key].value_or(std::string()); }

  std::filesystem::path folder_;
  ImportedRobot robot_;
  toml::table document_;
};

}  // namespace musclesim
