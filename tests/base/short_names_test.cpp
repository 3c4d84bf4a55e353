#include "base/short_names.h"

#include <gtest/gtest.h>

namespace musclesim {
namespace {

TEST(ShortNames, HaveAFolderOnlyWhereTheyNeedOne) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(shortNames({"/data/a.csv", "b.csv"}), (Names{"a.csv", "b.csv"}));
  EXPECT_EQ(shortNames({"/data/one/run.csv", "two/run.csv", "/c.csv"}), (Names{"one/run.csv", "two/run.csv", "c.csv"}));
  EXPECT_EQ(shortNames({"run.csv", "two/run.csv"}), (Names{"run.csv", "two/run.csv"}));
}

}  // namespace
}  // namespace musclesim
