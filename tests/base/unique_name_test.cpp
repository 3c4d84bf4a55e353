#include "musclesim/base/unique_name.h"

#include <gtest/gtest.h>

#include <set>

namespace musclesim {
namespace {

TEST(UniqueName, HasSixteenHexadecimalDigitsAndDoesNotRepeat) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = uniqueName();
    EXPECT_EQ(name.size(), 16u);
    EXPECT_EQ(name.find_first_not_of("0123456789abcdef"), std::string::npos) << name;
    seen.insert(name);
  }
  EXPECT_EQ(seen.size(), 1000u);
}

}  // namespace
}  // namespace musclesim
