#include <gtest/gtest.h>

#include "log/matlab.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(MatlabAbsent, SaysWhatIsMissing) {
  std::vector<std::string> notes;
  EXPECT_TRUE(
      contains(messageOf<BadFile>([&] { matlabTable("run.mat", "", notes); }), "was built without libmatio (package libmatio-dev)"));
}

}  // namespace
}  // namespace musclesim
