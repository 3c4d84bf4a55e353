/// Feeds the stored corpus, and truncated and altered variants of it, to every target without a fuzzer.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "fuzz/targets.h"
#include "musclesim/base/random.h"
#include "support/support.h"

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

/// A place in the text.
std::size_t placeIn(const std::string& text, RandomStream& random) {
  return static_cast<std::size_t>(random.uniform(0, static_cast<double>(text.size())));
}

/// One to four changes: a byte replaced, a part removed, doubled, or put elsewhere.
std::string altered(std::string text, RandomStream& random) {
  constexpr double longest_part = 40;
  for (int changes = static_cast<int>(random.uniform(1, 5)); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = placeIn(text, random);
    const std::string part = text.substr(at, static_cast<std::size_t>(random.uniform(1, longest_part)));
    switch (static_cast<int>(random.uniform(0, 4))) {
      case 0:
        text[at] = static_cast<char>(random.uniform(0, 256));
        break;
      case 1:
        text.erase(at, part.size());
        break;
      case 2:
        text.insert(at, part);
        break;
      default:
        text.insert(placeIn(text, random), part);
    }
  }
  return text;
}

/// MUSCLESIM_LONG_TESTS=1: as many as 10 s allow; without, 40 per file.
TEST_P(FuzzCorpus, AlteredIsTakenToo) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(longTests() ? 10 : 0);
  RandomStream random(1, "fuzz.alter");
  std::vector<std::string> originals;
  for (const auto& entry : fs::directory_iterator(fs::path(MUSCLESIM_CORPUS) / GetParam().first))
    originals.push_back(contentOf(entry.path()));
  std::ranges::sort(originals);  // the folder has no order
  long count = 0;
  for (int round = 0; round < 20 || Clock::now() < end; ++round)
    for (const std::string& original : originals) {
      const std::string text = altered(original, random);
      feed(text);
      feed(text.substr(0, text.empty() ? 0 : placeIn(text, random)));
      count += 2;
    }
  if (longTests()) std::printf("altered inputs: %s %ld\n", GetParam().first.c_str(), count);
}

INSTANTIATE_TEST_SUITE_P(Of, FuzzCorpus, testing::ValuesIn(fuzzTargets()), [](const auto& tested) { return tested.param.first; });

}  // namespace
}  // namespace musclesim
