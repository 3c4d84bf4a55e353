/// Helpers for the tests of several folders.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace musclesim {

/// The message of the Exception that an action throws. Any other exception passes through and fails the test.
template <class Exception, class Function>
std::string messageOf(const Function& action) {
  try {
    action();
  } catch (const Exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// EXPECT_TRUE(contains(message, "part")) prints the message when it fails.
inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

/// Reference data that are not part of this repository: the folder named by MUSCLESIM_SHARED, or `shared` beside the repository.
/// Tests that need them are skipped if they are missing.
inline std::filesystem::path sharedFolder() {
  const char* given = std::getenv("MUSCLESIM_SHARED");
  return given ? given : MUSCLESIM_SHARED_FOLDER;
}

/// Whether tests may take minutes: set MUSCLESIM_LONG_TESTS=1.
inline bool longTests() {
  const char* given = std::getenv("MUSCLESIM_LONG_TESTS");
  return given && std::string(given) == "1";
}

}  // namespace musclesim
