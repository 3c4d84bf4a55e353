#include "base/apart.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(Apart, ReturnsTheTextOrTheError) {
  EXPECT_EQ(doApart("file", {}, [] { return std::string("text\0more", 9); }), std::string("text\0more", 9));
  EXPECT_EQ(messageOf<BadFile>([] { doApart("file", {}, []() -> std::string { throw BadFile("file", "is odd"); }); }), "file: is odd");
}

TEST(Apart, SurvivesACrashAndWhatTakesTooMuch) {
  EXPECT_TRUE(contains(messageOf<BadFile>([] { doApart("file", {}, []() -> std::string { std::abort(); }); }),
                       "file: is damaged: the library that reads such files crashes on it"));
  if (!apart_is_limited) GTEST_SKIP() << "no limits under this sanitizer";
  EXPECT_TRUE(contains(messageOf<BadFile>([] { doApart("file", {}, [] { return std::string(std::size_t{1} << 30, 'x'); }); }),
                       "file: needs more than 256 MB"));
  EXPECT_TRUE(contains(messageOf<BadFile>([] {
                         doApart("file", {}, [] {
                           for (volatile bool endless = true; endless;) {
                           }
                           return std::string();
                         });
                       }),
                       "file: takes longer than 1 s"));
}

}  // namespace
}  // namespace musclesim
