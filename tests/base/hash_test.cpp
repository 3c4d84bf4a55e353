#include "musclesim/base/hash.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace musclesim {
namespace {

std::string hashOf(const std::vector<std::string>& parts) {
  Hash hash;
  for (const std::string& part : parts) hash.add(part);
  return hash.text();
}

TEST(Hash, DependsOnEveryByteAndOnWhereTextsEnd) {
  EXPECT_EQ(hashOf({"lever"}).size(), 16U);
  EXPECT_EQ(hashOf({"lever"}), hashOf({"lever"}));
  EXPECT_NE(hashOf({"lever"}), hashOf({"levar"}));
  EXPECT_NE(hashOf({"ab", "c"}), hashOf({"a", "bc"}));
  EXPECT_NE(hashOf({}), hashOf({""}));
}

TEST(Hash, TellsMinusZeroFromZero) {
  Hash plus, minus;
  plus.add(0.0);
  minus.add(-0.0);
  EXPECT_NE(plus.value(), minus.value());
}

}  // namespace
}  // namespace musclesim
