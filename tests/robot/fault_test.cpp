/// Whatever happens to the bodies, ODE does not abort the process: the run ends in Diverged, and the next simulation is not affected.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "musclesim/base/error.h"
#include "musclesim/simulation/simulation.h"
#include "support/not_finite.h"
#include "support/support.h"

/// An exception thrown during a step leaks ODE's list of jobs. Nothing else may leak.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:dxtemplateThreadingImplementation";
}

namespace musclesim {
namespace {

SimulationOptions smallArm() {
  SimulationOptions options;
  options.step_s = 0.001;
  options.parameters.set("arm.muscle_count", 1.0, "test");
  return options;
}

dBodyID bone(Simulation& simulation, const std::string& name) {
  for (const auto& primitive : simulation.world().primitives())
    if (primitive->name() == name) return primitive->body().id;
  throw BadParameter("no bone " + name);
}

std::vector<double> healthyRun() {
  Simulation simulation(smallArm());
  simulation.build("arm");
  simulation.start("built", {0.3});
  for (int i = 0; i < 20; ++i) simulation.step();
  return simulation.robot().signalValues(simulation.robot().getState());
}

struct Fault {
  std::string name;
  std::function<void(Simulation&)> afflict;  ///< called before every step
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << fault.name;
}

std::vector<Fault> faults() {
  std::vector<Fault> all;
  auto addForce = [&](const std::string& name, double force) {
    all.push_back({name, [force](Simulation& s) { dBodyAddForce(bone(s, "medius"), 0, force, 0); }});
  };
  addForce("NanForceOnABone", nan);
  addForce("InfiniteForceOnABone", inf);
  addForce("HugeForceOnABone", 1e300);
  addForce("LargeForceOnABone", 1e12);
  all.push_back({"NanTorqueOnABone", [](Simulation& s) { dBodyAddTorque(bone(s, "ulna"), nan, 0, 0); }});
  all.push_back({"HugeTorqueOnABone", [](Simulation& s) { dBodyAddTorque(bone(s, "ulna"), 1e300, 1e300, -1e300); }});
  all.push_back({"NanForceOnABead", [](Simulation& s) { dBodyAddForce(s.world().actuators()[0]->links()[1].bead[0], nan, nan, nan); }});
  all.push_back({"HugeForceOnABead", [](Simulation& s) { dBodyAddForce(s.world().actuators()[0]->links()[1].bead[0], 1e200, 0, 0); }});
  all.push_back({"HandTornOff", [](Simulation& s) {
                   const double* p = dBodyGetPosition(bone(s, "medius"));
                   dBodySetPosition(bone(s, "medius"), p[0] + 100, p[1], p[2]);
                 }});
  all.push_back({"BonesPulledApart", [](Simulation& s) {
                   dBodyAddForce(bone(s, "medius"), 0, -3e11, 0);
                   dBodyAddForce(bone(s, "humerus"), 0, 3e11, 0);
                 }});
  all.push_back({"BoneAtNan", [](Simulation& s) { dBodySetPosition(bone(s, "medius"), nan, 0, 0); }});
  all.push_back({"BoneFarAway", [](Simulation& s) { dBodySetPosition(bone(s, "medius"), 1e30, 0, 0); }});
  all.push_back({"BoneAtInfinity", [](Simulation& s) { dBodySetPosition(bone(s, "medius"), inf, 0, 0); }});
  all.push_back({"BoneTooFast", [](Simulation& s) { dBodySetLinearVel(bone(s, "medius"), 1e200, 0, 0); }});
  all.push_back({"BoneSpinsTooFast", [](Simulation& s) { dBodySetAngularVel(bone(s, "medius"), 1e200, 1e200, 0); }});
  all.push_back({"BoneSpinsAtNan", [](Simulation& s) { dBodySetAngularVel(bone(s, "medius"), nan, 0, 0); }});
  return all;
}

class AFault : public ::testing::TestWithParam<Fault> {};

TEST_P(AFault, EndsInDivergedAndLeavesTheNextSimulationAsItWouldHaveBeen) {
  static const std::vector<double> before = healthyRun();
  for (const StepperKind stepper : {StepperKind::automatic, StepperKind::ode, StepperKind::quick}) {
    SimulationOptions options = smallArm();
    options.stepper = stepper;
    Simulation simulation(options);
    simulation.build("arm");
    simulation.start("built", {0.3});
    simulation.step();
    std::string message;
    for (int i = 0; i < 100 && message.empty(); ++i) {
      GetParam().afflict(simulation);
      try {
        simulation.step();
      } catch (const Diverged& diverged) {
        message = diverged.what();
        EXPECT_GE(diverged.time_s(), 0.001 - 1e-12);
        EXPECT_FALSE(diverged.where().empty());
      }
    }
    EXPECT_TRUE(contains(message, "the simulation diverged at")) << simulation.stepper().name();
    EXPECT_NO_THROW(simulation.robot().getState()) << "the last state can still be read";
  }
  EXPECT_EQ(healthyRun(), before);
}

TEST_P(AFault, LeavesASimulationThatRefusesFurtherStepsWithoutAborting) {
  Simulation simulation(smallArm());
  simulation.build("arm");
  simulation.start("built", {0.3});
  for (int i = 0, failures = 0; i < 100 && failures < 3; ++i) {
    if (failures == 0) GetParam().afflict(simulation);
    try {
      simulation.step();
      EXPECT_EQ(failures, 0) << "a run that diverged goes on";
    } catch (const Diverged&) {
      ++failures;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, AFault, ::testing::ValuesIn(faults()), [](const auto& tested) { return tested.param.name; });

TEST(AFaultOfASimulation, DoesNotDisturbAnotherThatIsAliveBesideIt) {
  const auto before = healthyRun();
  Simulation healthy(smallArm());
  healthy.build("arm");
  healthy.start("built", {0.3});
  for (int i = 0; i < 20; ++i) {
    if (i == 10) {
      Simulation broken(smallArm());
      broken.build("arm");
      broken.start("built", {0.3});
      dBodyAddForce(bone(broken, "medius"), nan, 0, 0);
      EXPECT_THROW(broken.step(), Diverged);
    }
    healthy.step();
  }
  EXPECT_EQ(healthy.robot().signalValues(healthy.robot().getState()), before);
}

}  // namespace
}  // namespace musclesim
