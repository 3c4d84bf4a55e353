#include "base/toml_document.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// toml++ would go through these by recursion, for which the stack has no room.
TEST(TomlDocument, RefusesKeysOfThousandsOfParts) {
  for (const std::string key : {"a", "\"#=\"", "'=' ", " a\t"}) {
    const std::string deep = repeated(key + ".", 100'000) + key;
    for (const std::string& text : {deep + " = 1", "[" + deep + "]", "[[" + deep + "]]", "x = { " + deep + " = 1 }"})
      EXPECT_TRUE(contains(messageOf<BadFile>([&] { parseToml("ok = 1\n" + text, "f.toml"); }), "f.toml:2: a key has more than 100 parts"))
          << key;
  }
}

TEST(TomlDocument, DotsElsewhereAreNoKeys) {
  const std::string dots = repeated("a.", 1000);
  const auto table = parseToml("# " + dots + "\na.b.c = \"" + dots + "\"\nlist = [" + repeated("0.5, ", 1000) + "]\nlong = '''\n" + dots +
                                   "\n'''\nlast = \"\\\"" + dots + "\"\n",
                               "f.toml");
  EXPECT_EQ(table["a"]["b"]["c"].value<std::string>(), dots);
  EXPECT_EQ(table["list"].as_array()->size(), 1000u);
  EXPECT_EQ(table["last"].value<std::string>(), "\"" + dots);
}

}  // namespace
}  // namespace musclesim
