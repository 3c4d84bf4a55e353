/// The same binary and input give the same bits; compared by hashes of the whole state every 100 steps.
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "musclesim/base/hash.h"
#include "musclesim/base/random.h"
#include "musclesim/simulation/simulation.h"
#include "support/support.h"

namespace musclesim {
namespace {

/// Hash of the bits of all bodies' positions, orientations and velocities.
void addState(Hash& hash, Simulation& simulation) {
  for (dBodyID body = nullptr; const auto& primitive : simulation.world().primitives()) {
    if (primitive->body().id == body || primitive->body().id == nullptr) continue;
    body = primitive->body().id;
    for (int i = 0; i < 3; ++i)
      for (const double* numbers : {dBodyGetPosition(body), dBodyGetLinearVel(body), dBodyGetAngularVel(body)}) hash.add(numbers[i]);
    for (int i = 0; i < 4; ++i) hash.add(dBodyGetQuaternion(body)[i]);
  }
  for (const double value : simulation.robot().signalValues(simulation.robot().getState())) hash.add(value);
}

struct Case {
  std::string robot;
  StepperKind stepper;
  int step_count;
};

std::vector<std::string> hashes(const Case& run) {
  SimulationOptions options;
  options.stepper = run.stepper;
  options.parameters.set("arm.muscle_count", 2.0, "test");
  options.effects = {{"sensor_dropout", "all", {{"fraction", 0.1}}}};
  Simulation simulation(options);
  simulation.build(run.robot);
  RandomStream random(7, "determinism.pressures");
  simulation.start("built", Action(static_cast<std::size_t>(simulation.robot().actuatorCount()), 0.2));
  std::vector<std::string> hashes;
  Hash hash;
  for (int step = 1; step <= run.step_count; ++step) {
    Action action;
    for (int i = 0; i < simulation.robot().actuatorCount(); ++i) action.push_back(random.uniform(0, 0.5));
    if (step % 25 == 1) simulation.robot().step(action);
    simulation.step();
    if (step % 100 != 0) continue;
    addState(hash, simulation);
    hashes.push_back(hash.text());
  }
  return hashes;
}

class Determinism : public testing::TestWithParam<Case> {};

TEST_P(Determinism, RepeatsAndThreadsGiveTheSameHashes) {
  const std::vector<std::string> expected = hashes(GetParam());
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(GetParam().step_count / 100));
  EXPECT_EQ(std::set<std::string>(expected.begin(), expected.end()).size(), expected.size()) << "the state moves";
  const int repeats = longTests() ? 100 : 2;
  for (int i = 0; i < repeats / 2; ++i) {
    std::vector<std::string> beside;
    std::thread other([&] { beside = hashes(GetParam()); });
    const std::vector<std::string> here = hashes(GetParam());
    other.join();
    ASSERT_EQ(here, expected) << "repeat " << i;
    ASSERT_EQ(beside, expected) << "repeat " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Determinism,
                         testing::Values(Case{"rig", StepperKind::automatic, 300}, Case{"elbow", StepperKind::automatic, 200},
                                         Case{"rig", StepperKind::ode, 200}, Case{"rig", StepperKind::quick, 200},
                                         Case{"arm", StepperKind::automatic, 100}),
                         [](const auto& tested) {
                           return tested.param.robot + "_" + std::to_string(static_cast<int>(tested.param.stepper));
                         });

}  // namespace
}  // namespace musclesim
