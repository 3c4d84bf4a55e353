/// Feeds the stored corpus, and truncated and altered variants of it, to every target without a fuzzer.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fuzz/targets.h"
#include "musclesim/base/random.h"

namespace musclesim {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class FuzzCorpus : public testing::TestWithParam<std::pair<std::string, FuzzTarget>> {
 protected:
  static void feed(const std::string& bytes) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_NO_THROW(GetParam().second(bytes)) << bytes;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1)) << bytes;
  }
};

TEST_P(FuzzCorpus, IsTaken) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(MUSCLESIM_CORPUS) / GetParam().first)) {
    feed(contentOf(entry.path()));
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST_P(FuzzCorpus, AlteredIsTakenToo) {
  RandomStream random(1, "fuzz.alter");
  for (const auto& entry : fs::directory_iterator(fs::path(MUSCLESIM_CORPUS) / GetParam().first)) {
    const std::string original = contentOf(entry.path());
    for (int i = 0; i < 20 && !original.empty(); ++i) {
      std::string altered = original;
      const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(altered.size())));
      altered[at] = static_cast<char>(random.uniform(0, 256));
      feed(altered);
      feed(altered.substr(0, at));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FuzzCorpus, testing::ValuesIn(fuzzTargets()), [](const auto& tested) { return tested.param.first; });

}  // namespace
}  // namespace musclesim
