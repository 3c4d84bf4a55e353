#include "simulation/display/overlay.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace musclesim {
namespace {

/// Remembers where texts stand.
class Listing final : public Painter {
 public:
  struct Text {
    Eigen::AlignedBox2f box;
    std::string words;
  };
  void rectangle(float, float, float, float, const Color&, float) override {}
  void text(float x, float y, const std::string& words, const Color&) override {
    texts.push_back({{Eigen::Vector2f(x, y), Eigen::Vector2f(x + widthOf(words), y + lineHeight() - 1)}, words});
  }
  float widthOf(const std::string& words) const override { return 8 * static_cast<float>(words.size()); }
  float lineHeight() const override { return 19; }

  std::vector<Text> texts;
};

void expectNoTextOverText(const Console& console, const Snapshot& snapshot, float width_px) {
  Listing listing;
  drawOverlay(listing, console, snapshot, width_px, 480, true);
  EXPECT_GT(listing.texts.size(), 2u);
  for (std::size_t i = 0; i < listing.texts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(listing.texts[i].box.intersects(listing.texts[j].box)) << listing.texts[i].words << " / " << listing.texts[j].words;
}

/// One muscle and a hand.
Snapshot snapshot() {
  Snapshot result;
  result.state = {1, {0.2}, {0.2}, {10}, {200}, {}, Vector(100, -200, 0)};
  result.hoses.push_back({{{0, 0, 0}, {0, -200, 0}}, 5, {}, 10, 120, 300, 200});
  return result;
}

TEST(Overlay, NoTextOfARunStandsOnAnother) {
  Pace pace(1);
  Console console(std::make_shared<ShownRun>(ShownRun{std::make_shared<Hands>(1), "rig", "hold"}), pace);
  console.select(0);
  for (const float width_px : {320.0F, 640.0F}) {
    expectNoTextOverText(console, snapshot(), width_px);
    console.say("muscles under manual control");
    expectNoTextOverText(console, snapshot(), width_px);
    console.say("a message so long that it does not fit into the width of a window and therefore takes several lines of text there");
    expectNoTextOverText(console, snapshot(), width_px);
    console.press('f');
    console.press('h');
    expectNoTextOverText(console, snapshot(), width_px);
    console.press('h');
  }
}

TEST(Overlay, NoTextOfAReplayStandsOnAnother) {
  Trajectory trajectory{{snapshot(), snapshot()}, {{"length_0_mm", {0, 1}, {200, 200}, {200, 210}, 0.1}}, std::nullopt};
  const auto ghost = std::make_shared<DrawnGhost>(DrawnGhost{{}, snapshot().hoses});
  Player player({0, 1}, {trajectory, trajectory}, {ghost, ghost}, "from the muscle lengths");
  Pace pace(1);
  Console console(player, pace, Camera{});
  for (const char key : {'e', 'g', 'h'}) {
    expectNoTextOverText(console, snapshot(), 640);
    console.press(key);
    expectNoTextOverText(console, snapshot(), 640);
  }
}

}  // namespace
}  // namespace musclesim
