/// Force stage: limit cases in closed form, on a muscle whose length is prescribed.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "effect_runs.h"
#include "length_machine.h"
#include "musclesim/robot/chou_hannaford.h"
#include "musclesim/robot/sarosi.h"

namespace musclesim {
namespace {

constexpr double h_s = 3e-4;

TEST(ThresholdPressure, IsTheLawAtLessPressure) {
  LengthMachine machine({{"threshold_pressure", "all", {{"threshold", 0.1}}}});
  EXPECT_NEAR(machine.tensionAt(230), machine.lawN(0.4 / 0.9, 230), 1e-9);
  machine.setPressure(0.07);
  EXPECT_NEAR(machine.tensionAt(230), machine.lawN(0, 230), 1e-9);
}

TEST(ThresholdPressure, WithSoftnessHasNoKink) {
  LengthMachine machine({{"threshold_pressure", "all", {{"threshold", 0.1}, {"softness", 0.5}}}});
  const auto s = [](double p) { return 0.05 * std::log(1 + std::exp((p - 0.1) / 0.05)); };
  for (const double p : {0.0, 0.05, 0.1, 0.3, 1.0}) {
    machine.setPressure(p);
    EXPECT_NEAR(machine.tensionAt(230), machine.lawN((s(p) - s(0)) / (s(1) - s(0)), 230), 1e-9) << p;
  }
  LengthMachine gentle({{"threshold_pressure", "all", {{"threshold", 0.1}, {"softness", 1e-4}}}});
  EXPECT_NEAR(gentle.tensionAt(230), gentle.lawN(0.4 / 0.9, 230), 1e-9) << "the kink is its limit";
}

TEST(ForceGain, IsAFactor) {
  LengthMachine machine({{"force_gain", "muscle_0", {{"gain", 0.8}}}});
  EXPECT_NEAR(machine.tensionAt(230), 0.8 * machine.lawN(0.5, 230), 1e-9);
}

TEST(ForceDrift, GrowsWithTime) {
  LengthMachine machine({{"force_drift", "all", {{"rate_per_min", 0.05}}}});
  EXPECT_NEAR(machine.tensionAt(230), machine.lawN(0.5, 230), 1e-9);
  for (int i = 0; i < 900; ++i) machine.hold(0.1);
  EXPECT_NEAR(machine.tensionAt(230), 1.075 * machine.lawN(0.5, 230), 1e-9);
}

TEST(LengthOffset, IsTheLawAtAnotherLength) {
  LengthMachine machine({{"length_offset", "all", {{"offset_mm", -7.0}}}});
  EXPECT_NEAR(machine.tensionAt(230), machine.lawN(0.5, 223), 1e-9);
}

TEST(ForceLaw, IsTheOtherLaw) {
  LengthMachine sarosi({{"force_law", "all", {{"law", "sarosi"}, {"a5_N", 100.0}}}});
  SarosiConstants constants;
  constants.a5_N = 100;
  EXPECT_NEAR(sarosi.tensionAt(230), SarosiForceLaw(300, constants).tensionN(0.5, 230), 1e-9);
  LengthMachine braid({{"force_law", "all", {{"law", "chou-hannaford"}, {"rest_length_mm", 310.0}}}});
  EXPECT_NEAR(braid.tensionAt(230), ChouHannafordForceLaw(310, {}).tensionN(0.5, 230), 1e-9);
  LengthMachine corrected(
      {{"force_law",
        "all",
        {{"law", "corrected"}, {"braid_N", 6.0}, {"bore_N", 1.0}, {"elastic_N", 0.0}, {"threshold_N", 0.5}, {"stretch_N", 0.0}}}});
  EXPECT_NEAR(corrected.tensionAt(230), corrected.lawN(0.5, 230) + 0.5 * (6 * std::pow(230.0 / 300, 2) - 1) - 0.5, 1e-9);
  LengthMachine map({{"force_law", "all", {{"law", "map"}}}});
  EXPECT_NEAR(map.tensionAt(230), map.lawN(0.5, 230), 1.0);  // its defaults approximate Eq. 1
  LengthMachine same({{"force_law", "all", {{"law", "braun"}}}});
  EXPECT_EQ(same.tensionAt(230), same.lawN(0.5, 230));
}

TEST(BraidHysteresis, LoopIsTwiceTheWidthAtAnySpeed) {
  for (const double pressure : {0.3, 0.6})
    for (const double rate_mm_per_s : {10.0, 100.0}) {
      LengthMachine machine({{"braid_hysteresis", "all", {{"relative_width", 0.08}, {"presliding_mm", 1.5}}}}, pressure, 210);
      machine.moveTo(225, rate_mm_per_s, h_s);
      const double longer = machine.tensionAt(machine.lengthMm());
      machine.moveTo(230, rate_mm_per_s, h_s);
      machine.moveTo(225, rate_mm_per_s, h_s);
      const double shorter = machine.tensionAt(machine.lengthMm()), law = machine.lawN(pressure, 225);
      EXPECT_NEAR(longer, 1.08 * law, 1e-6) << rate_mm_per_s;
      EXPECT_NEAR(shorter, 0.92 * law, 1e-6) << rate_mm_per_s;
    }
}

TEST(BraidHysteresis, GoesWithThePressureAlone) {
  for (const double pressure : {0.3, 0.6})
    for (const double length_mm : {190.0, 240.0}) {
      LengthMachine machine({{"braid_hysteresis", "all", {{"relative_width", 0.05}, {"presliding_mm", 1.0}, {"pressure_share", 1.0}}}},
                            pressure, length_mm - 10);
      machine.moveTo(length_mm, 50, h_s);
      const double friction_N = 0.05 * pressure * machine.lawN(1, 300);
      EXPECT_NEAR(machine.tensionAt(length_mm), machine.lawN(pressure, length_mm) + friction_N, 1e-6) << pressure << " " << length_mm;
      machine.moveTo(length_mm + 5, 50, h_s);
      machine.moveTo(length_mm, 50, h_s);
      EXPECT_NEAR(machine.tensionAt(length_mm), machine.lawN(pressure, length_mm) - friction_N, 1e-6) << pressure << " " << length_mm;
    }
}

TEST(BraidHysteresis, MayBeConstant) {
  for (const double pressure : {0.3, 0.6})
    for (const double length_mm : {230.0, 250.0}) {
      LengthMachine machine({{"braid_hysteresis", "all", {{"constant_friction_N", 6.0}, {"presliding_mm", 1.0}}}}, pressure,
                            length_mm - 10);
      machine.moveTo(length_mm, 50, h_s);
      const double friction_N = 6, law_N = machine.lawN(pressure, length_mm);
      ASSERT_GT(law_N, friction_N);
      EXPECT_NEAR(machine.tensionAt(length_mm), law_N + friction_N, 1e-6) << pressure << " " << length_mm;
      machine.moveTo(length_mm + 5, 50, h_s);
      machine.moveTo(length_mm, 50, h_s);
      EXPECT_NEAR(machine.tensionAt(length_mm), law_N - friction_N, 1e-6) << pressure << " " << length_mm;
    }
}

TEST(BraidHysteresis, DoesNotPush) {
  LengthMachine machine({{"braid_hysteresis", "all", {{"relative_width", 1.0}, {"presliding_mm", 1.0}, {"pressure_share", 1.0}}}}, 0.2,
                        260);
  machine.moveTo(200, 50, h_s);
  EXPECT_EQ(machine.tensionAt(200), 0);
}

/// 1 + z after a reversal from z = -1, way x in units of the presliding: 2 (1 - e^-x) for i = 1, 2 - (sqrt(2) - x / 2)^2 for i = 1/2.
TEST(BraidHysteresis, MaySlideLittleByLittle) {
  for (const double exponent : {0.5, 1.0})
    for (const double way_mm : {0.6, 1.5, 3.0}) {
      LengthMachine machine(
          {{"braid_hysteresis", "all", {{"relative_width", 0.1}, {"presliding_mm", 1.5}, {"presliding_exponent", exponent}}}}, 0.5, 200);
      machine.moveTo(240, 50, h_s);
      EXPECT_NEAR(machine.tensionAt(240), 1.1 * machine.lawN(0.5, 240), 1e-3);
      machine.moveTo(240 - way_mm, 50, h_s);
      const double x = way_mm / 1.5, z = exponent == 1 ? 1 - 2 * std::exp(-x) : 1 - std::pow(std::sqrt(2) - x / 2, 2);
      const double length_mm = machine.lengthMm();
      EXPECT_NEAR(machine.tensionAt(length_mm), machine.lawN(0.5, length_mm) * (1 - 0.1 * z), 1e-3) << exponent << " " << way_mm;
    }
}

TEST(BraidHysteresis, ReversesOverTwicePresliding) {
  LengthMachine machine({{"braid_hysteresis", "all", {{"relative_width", 0.1}, {"presliding_mm", 1.5}}}}, 0.5, 210);
  machine.moveTo(225, 50, h_s);
  machine.moveTo(223.5, 50, h_s);  // half of the play
  EXPECT_NEAR(machine.tensionAt(223.5), machine.lawN(0.5, 223.5), 1e-6);
}

TEST(ViscousLoss, GrowsWithSpeedAndDirection) {
  for (const double rate_mm_per_s : {10.0, 100.0}) {
    LengthMachine machine({{"viscous_loss", "all", {{"damping_Ns_per_m", 200.0}, {"shortening_ratio", 1.5}}}}, 0.5, 205);
    machine.moveTo(225, rate_mm_per_s, h_s);
    const double law = machine.lawN(0.5, 225);
    EXPECT_NEAR(machine.tensionAt(225) - law, 0.2 * rate_mm_per_s, 1e-3 * rate_mm_per_s);
    machine.moveTo(230, rate_mm_per_s, h_s);
    machine.moveTo(225, rate_mm_per_s, h_s);
    EXPECT_NEAR(machine.tensionAt(225) - law, -0.3 * rate_mm_per_s, 1e-3 * rate_mm_per_s);
  }
}

/// The present length at which the machine's muscle carries a load.
double lengthUnder(LengthMachine& machine, double load_N) {
  double low_mm = 130, high_mm = 295;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low_mm + high_mm) / 2;
    (machine.tensionAt(middle) < load_N ? low_mm : high_mm) = middle;
  }
  machine.tensionAt(low_mm);
  return low_mm;
}

TEST(Creep, ReachesItsShareAtOnceAndTheRestWithItsTimeConstant) {
  const double amount = 0.2, tau_s = 0.6, load_N = 20;
  LengthMachine machine({{"creep", "all", {{"amount", amount}, {"time_constant_s", tau_s}}}}, 0.4, 220);
  for (int i = 0; i < 10000; ++i) {  // creep under the load until it is complete
    lengthUnder(machine, load_N);
    machine.hold(1e-3);
  }
  const double before_mm = lengthUnder(machine, load_N);
  machine.setPressure(0.6);
  const double first_mm = lengthUnder(machine, load_N);
  double later_mm = 0;
  for (int i = 0; i < 10000; ++i) {
    machine.hold(1e-3);
    const double length_mm = lengthUnder(machine, load_N);
    if (i == 599) later_mm = length_mm;
  }
  const double final_mm = lengthUnder(machine, load_N);
  EXPECT_LT(final_mm, before_mm - 10);
  EXPECT_NEAR((first_mm - before_mm) / (final_mm - before_mm), 1 / (1 + amount), 1e-5);
  EXPECT_NEAR((later_mm - final_mm) / (first_mm - final_mm), std::exp(-1), 2e-3);
}

TEST(Creep, RelaxesAtConstantLength) {
  const double amount = 0.2, tau_s = 0.6;
  LengthMachine machine({{"creep", "all", {{"amount", amount}, {"time_constant_s", tau_s}}}}, 0.5, 220);
  const double share = amount / (1 + amount), from_mm = share * (220 - 300.0), to_mm = share * (240 - 300.0);
  EXPECT_NEAR(machine.tensionAt(220), machine.lawN(0.5, 220 - from_mm), 1e-9);
  machine.tensionAt(240);
  for (int i = 0; i < 500; ++i) machine.hold(1e-3);
  const double creep_mm = to_mm + (from_mm - to_mm) * std::exp(-0.5 * (1 + amount) / tau_s);
  EXPECT_NEAR(machine.tensionAt(240), machine.lawN(0.5, 240 - creep_mm), 1e-6);
}

/// Four elements with time constants in a geometric series, integrated in small steps at a constant length.
double creepOfFourElementsMm(double amount, double tau_s, double decades, double from_mm, double to_mm, double duration_s) {
  const double share = amount / 4;
  std::vector<double> x(4, share / (1 + amount) * from_mm), tau;
  for (int i = 0; i < 4; ++i) tau.push_back(tau_s * std::pow(10, decades * (i / 3.0 - 0.5)));
  const int steps = 200000;
  for (int step = 0; step < steps; ++step) {
    const double free_mm = to_mm - (x[0] + x[1] + x[2] + x[3]);
    for (std::size_t i = 0; i < 4; ++i) x[i] += duration_s / steps / tau[i] * (share * free_mm - x[i]);
  }
  return x[0] + x[1] + x[2] + x[3];
}

TEST(Creep, WithASpreadIsASeriesOfElements) {
  const double amount = 0.2, tau_s = 0.6, decades = 1.7;
  for (const double duration_s : {0.1, 0.5, 2.0}) {
    LengthMachine machine({{"creep", "all", {{"amount", amount}, {"time_constant_s", tau_s}, {"spread_decades", decades}}}}, 0.5, 220);
    EXPECT_NEAR(machine.tensionAt(220), machine.lawN(0.5, 220 + 80 * amount / (1 + amount)), 1e-9) << "settled as with one element";
    machine.tensionAt(240);
    for (int i = 0; i < 100; ++i) machine.hold(duration_s / 100);
    const double creep_mm = creepOfFourElementsMm(amount, tau_s, decades, 220 - 300, 240 - 300, duration_s);
    EXPECT_NEAR(machine.tensionAt(240), machine.lawN(0.5, 240 - creep_mm), 1e-4) << duration_s;
  }
}

TEST(Creep, WithHardlyAnySpreadIsOneElement) {
  const auto relaxedN = [](double decades) {
    LengthMachine machine({{"creep", "all", {{"amount", 0.2}, {"time_constant_s", 0.6}, {"spread_decades", decades}}}}, 0.5, 220);
    machine.tensionAt(240);
    for (int i = 0; i < 500; ++i) machine.hold(1e-3);
    return machine.tensionAt(240);
  };
  EXPECT_NEAR(relaxedN(1e-9), relaxedN(0), 1e-7);
}

TEST(SeriesElasticity, IsInSeriesWithTheLaw) {
  for (const double stiffness : {0.3, 5.0, 1000.0}) {
    LengthMachine machine({{"series_elasticity", "all", {{"stiffness_N_per_mm", stiffness}}}});
    const double tension = machine.tensionAt(240);
    EXPECT_GT(tension, 1);
    EXPECT_NEAR(tension, machine.lawN(0.5, 240 - tension / stiffness), 1e-6) << stiffness;
  }
}

TEST(SeriesElasticity, IsSlackWhereTheMuscleWouldPush) {
  LengthMachine machine({{"series_elasticity", "all", {{"stiffness_N_per_mm", 5.0}}}}, 0.5, 125);
  EXPECT_LT(machine.lawN(0.5, 118), 0);
  EXPECT_EQ(machine.tensionAt(120), machine.tensionAt(120));
  LengthMachine short_one({{"series_elasticity", "all", {{"stiffness_N_per_mm", 5.0}}}, {"length_offset", "all", {{"offset_mm", -20.0}}}},
                          0.5, 125);
  EXPECT_EQ(short_one.tensionAt(125), 0);
}

/// Net work that a machine does on a muscle along a random walk of its length, beyond the energy that the law returns.
double workAlongRandomWalk(const std::vector<ActiveEffect>& effects, unsigned seed) {
  LengthMachine machine(effects, 0.5, 220);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length_mm(200, 250), rate_mm_per_s(20, 200);
  double work_Nmm = 0, lowest_Nmm = 0, before_mm = 220, before_N = 0;
  for (int leg = 0; leg < 30; ++leg)
    machine.moveTo(length_mm(random), rate_mm_per_s(random), h_s, [&](double now_mm, double tension_N) {
      const double loss_N = tension_N - machine.lawN(0.5, now_mm);
      work_Nmm += (now_mm - before_mm) * (loss_N + before_N) / 2;
      lowest_Nmm = std::min(lowest_Nmm, work_Nmm);
      before_mm = now_mm;
      before_N = loss_N;
    });
  EXPECT_GE(lowest_Nmm, -1e-3) << "energy came out of it";
  return work_Nmm;
}

TEST(DissipativeForces, NeverGiveEnergy) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    EXPECT_GT(workAlongRandomWalk({{"braid_hysteresis", "all", {{"relative_width", 0.1}, {"presliding_mm", 3.0}}}}, seed), 100);
    EXPECT_GT(workAlongRandomWalk({{"viscous_loss", "all", {{"damping_Ns_per_m", 3000.0}}}}, seed), 100);
  }
}

TEST(ForceEffects, EncloseEachOther) {
  // From the inside to the outside: gain, offset, tendon.
  LengthMachine machine({{"series_elasticity", "all", {{"stiffness_N_per_mm", 2.0}}},
                         {"length_offset", "all", {{"offset_mm", 4.0}}},
                         {"force_gain", "all", {{"gain", 0.9}}}});
  const double tension = machine.tensionAt(240);
  EXPECT_NEAR(tension, 0.9 * machine.lawN(0.5, 240 - tension / 2 + 4), 1e-6);
}

}  // namespace
}  // namespace musclesim
