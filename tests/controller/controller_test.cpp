#include "musclesim/controller/controller.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "controller/request.h"
#include "musclesim/base/error.h"
#include "support/support.h"

namespace musclesim {
namespace {

using test::Prepared;

class ThirdController final : public Controller {
 public:
  Action output(const State&) override { return {1.0 / 3}; }
};

TEST(Controller, BuildsTheBuiltInOnesByName) {
  for (const std::string name : {"aasm", "asm", "hold", "random"}) {
    Prepared prepared;
    const auto controller = Controller::make(name, prepared.request);
    EXPECT_EQ(controller->output(test::stateAtHeight(-240)).size(), 2u) << name;
    EXPECT_FALSE(Controller::description(name).empty());
  }
  const auto names = Controller::names();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_GE(names.size(), 4u);
}

TEST(Controller, UnknownNameSuggestsTheNearest) {
  Prepared prepared;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Controller::make("asmm", prepared.request); }), "did you mean \"asm\"?"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Controller::make("hodl", prepared.request); }), "did you mean \"hold\"?"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Controller::make("zzzzzz", prepared.request); }), "be one of aasm, asm, hold"));
  EXPECT_THROW(Controller::description("asmm"), BadParameter);
}

TEST(Controller, UsersRegisterTheirOwn) {
  Controller::registerController("third", "always a third", [](const ControllerRequest&) { return std::make_unique<ThirdController>(); });
  Prepared prepared;
  EXPECT_EQ(Controller::make("third", prepared.request)->output(State()), Action({1.0 / 3}));
  EXPECT_EQ(Controller::description("third"), "always a third");
  EXPECT_THROW(Controller::registerController("", "", [](const ControllerRequest&) { return nullptr; }), BadParameter);
  EXPECT_THROW(Controller::registerController("none", "", nullptr), BadParameter);
}

TEST(Controller, RejectsRequestsThatNoControllerCanServe) {
  for (const auto& name : {"asm", "aasm", "hold", "random"}) {
    Prepared prepared;
    prepared.request.muscle_count = 0;
    EXPECT_TRUE(contains(messageOf<BadParameter>([&] { Controller::make(name, prepared.request); }), "muscle count = 0")) << name;
  }
  Prepared prepared;
  prepared.request.step_s = 0;
  EXPECT_THROW(Controller::make("asm", prepared.request), BadParameter);
}

TEST(Controller, MisspelledParametersAreFoundByTheirNearestName) {
  Prepared prepared{"asm.noise_sdt=0.1"};
  Controller::make("asm", prepared.request);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { prepared.parameters.requireAllKnown(); }), "asm.noise_std"));
}

}  // namespace
}  // namespace musclesim
