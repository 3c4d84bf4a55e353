#include "musclesim/controller/channels.h"

#include <gtest/gtest.h>

#include "musclesim/base/error.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

TEST(Channels, AreReadAsTheyAreWritten) {
  const auto channels = channelsFrom("0,3:1,wrist=2+4:5+6", 7);
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_EQ(channels[0].rise, std::vector<int>({0}));
  EXPECT_TRUE(channels[0].fall.empty());
  EXPECT_EQ(channels[1].rise, std::vector<int>({3}));
  EXPECT_EQ(channels[1].fall, std::vector<int>({1}));
  EXPECT_EQ(channels[2].name, "wrist");
  EXPECT_EQ(channels[2].rise, std::vector<int>({2, 4}));
  EXPECT_EQ(channels[2].fall, std::vector<int>({5, 6}));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(channelsFrom(channels[i].text(), 7)[0].text(), channels[i].text());
}

TEST(Channels, RefuseWhatIsNone) {
  for (const char* text : {"", "a", "0:", "0;1", "0:1:2", "0+0", "0:0", "2", "-1", "0,", "1.5"})
    EXPECT_TRUE(contains(messageOf<BadParameter>([&] { channelsFrom(text, 2); }), "channel = ")) << text;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { channelsFrom("2", 2); }), "0 .. 1"));
}

TEST(Channels, ComeFromMomentArms) {
  Simulation simulation;
  const auto channels = antagonistsOf(simulation.build("wrist"));
  ASSERT_EQ(channels.size(), 1u);
  EXPECT_EQ(channels[0].rise.size(), 1u);
  EXPECT_EQ(channels[0].fall.size(), 1u);
  Simulation rig;
  EXPECT_TRUE(antagonistsOf(rig.build("rig")).empty()) << "one muscle, no angle";
  Simulation arm;
  EXPECT_TRUE(antagonistsOf(arm.build("arm")).empty()) << "its joints close a loop";
}

}  // namespace
}  // namespace musclesim
