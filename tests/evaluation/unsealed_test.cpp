// What a stopped `blind make` keeps.
#include "evaluation/blind/unsealed.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim::blind {
namespace {

namespace fs = std::filesystem;

class Unsealed : public ::testing::Test {
 protected:
  Unsealed() : folder_(fs::temp_directory_path() / ("musclesim_unsealed_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Unsealed() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Unsealed, KeepsKeysForTheSameCall) {
  const UnsealedCases first(folder_, {{"seed", 3}});
  EXPECT_FALSE(first.exist());
  first.begin();
  first.keep("case002", {{"kind", "single"}});
  const UnsealedCases second(folder_, {{"seed", 3}});
  EXPECT_TRUE(second.exist());
  EXPECT_FALSE(second.keyOf("case001"));
  EXPECT_EQ(second.keyOf("case002").value().at("kind"), "single");
}

TEST_F(Unsealed, RefusesAnotherCallAndNamesWhatToRemove) {
  UnsealedCases(folder_, {{"seed", 3}}).begin();
  const std::string message = messageOf<BadParameter>([&] { UnsealedCases(folder_, {{"seed", 4}}); });
  EXPECT_TRUE(contains(message, (folder_ / "unsealed").string())) << message;
}

TEST_F(Unsealed, LeavesNothingBehind) {
  const UnsealedCases cases(folder_, {{"seed", 3}});
  cases.begin();
  cases.keep("case001", {{"kind", "null"}});
  cases.remove();
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_FALSE(cases.exist());
}

}  // namespace
}  // namespace musclesim::blind
