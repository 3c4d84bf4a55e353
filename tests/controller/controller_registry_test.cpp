#include "musclesim/controller/controller_registry.h"

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
  explicit ThirdController(const ControllerRequest&) {}
  Action output(const State&) override { return {1.0 / 3}; }
};

TEST(ControllerRegistry, BuildsTheBuiltInOnesByName) {
  for (const std::string name : {"aasm", "asm", "hold", "random"}) {
    Prepared prepared;
    const auto controller = makeController(name, prepared.request);
    EXPECT_EQ(controller->output(test::stateAtHeight(-240)).size(), 2u) << name;
    EXPECT_FALSE(controllerDescription(name).empty());
  }
  const auto names = registeredControllers();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_GE(names.size(), 4u);
}

TEST(ControllerRegistry, UnknownNameSuggestsTheNearest) {
  Prepared prepared;
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("asmm", prepared.request); }), "did you mean \"asm\"?"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("hodl", prepared.request); }), "did you mean \"hold\"?"));
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController("zzzzzz", prepared.request); }), "be one of aasm, asm, chirp, hold"));
  EXPECT_THROW(controllerDescription("asmm"), BadParameter);
}

TEST(ControllerRegistry, UsersRegisterTheirOwn) {
  registerController<ThirdController>("third", "always a third");
  Prepared prepared;
  EXPECT_EQ(makeController("third", prepared.request)->output(State()), Action({1.0 / 3}));
  EXPECT_EQ(controllerDescription("third"), "always a third");
  registerController("third", "by a function", [](const ControllerRequest& r) { return std::make_unique<ThirdController>(r); });
  EXPECT_EQ(controllerDescription("third"), "by a function");
  EXPECT_THROW(registerController("", "", [](const ControllerRequest&) { return nullptr; }), BadParameter);
  EXPECT_THROW(registerController("none", "", nullptr), BadParameter);
}

TEST(ControllerRegistry, RejectsRequestsThatNoControllerCanServe) {
  for (const auto& name : {"asm", "aasm", "hold", "random"}) {
    Prepared prepared;
    prepared.request.muscle_count = 0;
    EXPECT_TRUE(contains(messageOf<BadParameter>([&] { makeController(name, prepared.request); }), "muscle count = 0")) << name;
  }
  Prepared prepared;
  prepared.request.step_s = 0;
  EXPECT_THROW(makeController("asm", prepared.request), BadParameter);
}

TEST(ControllerRegistry, MisspelledParametersAreFoundByTheirNearestName) {
  Prepared prepared{"asm.noise_sdt=0.1"};
  makeController("asm", prepared.request);
  EXPECT_TRUE(contains(messageOf<BadParameter>([&] { prepared.parameters.requireAllKnown(); }), "asm.noise_std"));
}

}  // namespace
}  // namespace musclesim
