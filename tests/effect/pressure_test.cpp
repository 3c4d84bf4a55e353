/// Pressure stage: limit cases in closed form.
#include "effect_runs.h"

namespace musclesim {
namespace {

Recording stepOf(const std::string& robot, const Action& from, const Action& to, double duration_s = 0.5) {
  return commandsFor(robot, duration_s, [=](double t) { return t < 0.0999 ? from : to; });
}

double sinceStep(double time_s) {
  return std::max(0.0, time_s - 0.1);
}

TEST(ValveLag, AnswersAStepExponentially) {
  const std::vector<ActiveEffect> lag = {{"valve_lag", "all", {{"fill_time_constant_s", 0.08}, {"vent_time_constant_s", 0.15}}}};
  const ReplayResult filling = replayWith(stepOf("rig", {0.3}, {0.5}), lag), venting = replayWith(stepOf("rig", {0.5}, {0.3}), lag);
  for (std::size_t row = 0; row < filling.simulated.time_s.size(); ++row) {
    const double t = sinceStep(filling.simulated.time_s[row]);
    EXPECT_NEAR(valuesOf(filling, "pressure_0")[row], 0.5 - 0.2 * std::exp(-t / 0.08), 1e-12);
    EXPECT_NEAR(valuesOf(venting, "pressure_0")[row], 0.3 + 0.2 * std::exp(-t / 0.15), 1e-12);
  }
}

/// What a step leaves: sum over k of tau_k^2 e^(-t / tau_k) / product over j != k of (tau_k - tau_j); with three equal lags of T it is
/// (1 + t / T + (t / T)^2 / 2) e^(-t / T). The second and third lag take their input as changing at a constant rate within an internal
/// step: an error of second order.
TEST(ValveLag, MayBeThreeLagsInSeries) {
  const double tau_s = 0.12;
  for (const double r : {0.5, 1.0}) {
    const double a = tau_s / (1 + r + r * r), b = a * r, c = b * r;
    const auto largestError = [&](int substeps) {
      ReplayOptions options;
      options.substeps = substeps;
      const ReplayResult run = replayWith(stepOf("rig", {0.3}, {0.5}),
                                          {{"valve_lag", "all", {{"fill_time_constant_s", tau_s}, {"next_lag_ratio", r}}}}, options);
      double largest = 0;
      for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
        const double t = sinceStep(run.simulated.time_s[row]);
        const double left = r == 1 ? (1 + t / a + t * t / (2 * a * a)) * std::exp(-t / a)
                                   : a * a * std::exp(-t / a) / ((a - b) * (a - c)) + b * b * std::exp(-t / b) / ((b - a) * (b - c)) +
                                         c * c * std::exp(-t / c) / ((c - a) * (c - b));
        largest = std::max(largest, std::abs(valuesOf(run, "pressure_0")[row] - (0.5 - 0.2 * left)));
      }
      return largest;
    };
    const double error = largestError(40);
    EXPECT_LT(error, 2e-6) << "internal steps of 0.25 ms";
    EXPECT_NEAR(error / largestError(80), 4, 0.1) << "of second order";
  }
}

TEST(FlowLimit, IsARampByDirection) {
  const std::vector<ActiveEffect> limit = {{"flow_limit", "all", {{"fill_rate_per_s", 1.0}, {"vent_rate_per_s", 0.5}}}};
  const ReplayResult filling = replayWith(stepOf("rig", {0.3}, {0.5}), limit), venting = replayWith(stepOf("rig", {0.5}, {0.3}), limit);
  for (std::size_t row = 0; row < filling.simulated.time_s.size(); ++row) {
    const double t = sinceStep(filling.simulated.time_s[row]);
    EXPECT_NEAR(valuesOf(filling, "pressure_0")[row], std::min(0.3 + 1.0 * t, 0.5), 1e-12);
    EXPECT_NEAR(valuesOf(venting, "pressure_0")[row], std::max(0.5 - 0.5 * t, 0.3), 1e-12);
  }
}

TEST(FlowLimit, LeavesSlowCommandsAlone) {
  const Recording commands = commandsFor("rig", 0.4, [](double t) { return Action{0.3 + 0.2 * t}; });
  const ReplayResult run = replayWith(commands, {{"flow_limit", "all", {{"fill_rate_per_s", 1.0}}}});
  // The commands rise in stairs of 0.002; the pressure reaches each stair in the first internal steps after its row.
  for (std::size_t row = 1; row < commands.time_s.size(); ++row)
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], commands.signals[0].values[row - 1], 1e-12);
}

TEST(FlowLimit, IsALagWithinItsBand) {
  const std::vector<ActiveEffect> limit = {{"flow_limit", "all", {{"fill_rate_per_s", 1.0}, {"proportional_band", 0.05}}}};
  const ReplayResult run = replayWith(stepOf("rig", {0.3}, {0.5}), limit);
  for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
    const double t = sinceStep(run.simulated.time_s[row]);
    const double expected = t < 0.15 ? 0.3 + t : 0.5 - 0.05 * std::exp(-(t - 0.15) / 0.05);
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], expected, 1e-12);
  }
}

/// p + p_atm falls exponentially with the time constant (1 + p_atm) / vent_rate until the command is reached.
TEST(FlowLimit, MayVentInProportionToTheAbsolutePressure) {
  const double atmosphere = 0.17, rate_per_s = 0.8;
  const auto largestError = [&](int substeps) {
    ReplayOptions options;
    options.substeps = substeps;
    const ReplayResult run = replayWith(stepOf("rig", {0.6}, {0.1}),
                                        {{"flow_limit", "all", {{"vent_rate_per_s", rate_per_s}, {"vent_pressure_share", 1.0}}}}, options);
    double largest = 0;
    for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
      const double t = sinceStep(run.simulated.time_s[row]);
      const double expected = (0.6 + atmosphere) * std::exp(-rate_per_s * t / (1 + atmosphere)) - atmosphere;
      largest = std::max(largest, std::abs(valuesOf(run, "pressure_0")[row] - expected));
    }
    return largest;
  };
  const double error = largestError(20);
  EXPECT_LT(error, 1e-4) << "internal steps of 0.5 ms";
  EXPECT_NEAR(error / largestError(40), 2, 0.05) << "of first order";
}

TEST(Leak, KnowsOtherRegulators) {
  const ReplayResult run =
      replayWith(stepOf("rig", {0.3}, {0.3}), {{"leak", "all", {{"leak_per_s", 2.0}, {"regulator_time_constant_s", 0.1}}}});
  for (const double p : valuesOf(run, "pressure_0")) EXPECT_NEAR(p, 0.3 / 1.2, 1e-12);
}

TEST(Leak, ThroughAHoleGoesWithThePowerOfThePressure) {
  const double k = 1.5, tau_s = 0.07, before = 0.6, u = 0.3;
  const std::vector<ActiveEffect> hole = {
      {"leak", "all", {{"leak_per_s", k}, {"regulator_time_constant_s", tau_s}, {"flow_exponent", 0.5}}}};
  const ReplayResult run = replayWith(stepOf("rig", {before}, {u}), hole);
  // At rest a quadratic equation of sqrt(p).
  const double half = k * tau_s / 2, root = std::sqrt(half * half + before) - half;
  EXPECT_NEAR(valuesOf(run, "pressure_0").front(), root * root, 1e-9);
  double p = root * root, t = 0;
  for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
    constexpr double h_s = 1e-6;
    for (const double end = sinceStep(run.simulated.time_s[row]); t + h_s / 2 < end; t += h_s)
      p += h_s * ((u - p) / tau_s - k * std::sqrt(p));
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], p, 2e-4);
  }
}

TEST(Leak, HoldsLessAndFollowsItsRegulator) {
  const double k = 2, u = 0.5, held = u / (1 + k * 0.05);
  const ReplayResult run = replayWith(stepOf("rig", {0.3}, {u}), {{"leak", "all", {{"leak_per_s", k}}}});
  EXPECT_NEAR(valuesOf(run, "pressure_0").front(), 0.3 / (1 + k * 0.05), 1e-12);
  for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
    const double t = sinceStep(run.simulated.time_s[row]);
    const double expected = held + (0.3 / (1 + k * 0.05) - held) * std::exp(-t * (1 / 0.05 + k));
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], expected, 1e-12);
  }
}

/// dp/dt = (u - p) / tau - k p: one lag, neither slower than the lag alone nor with a second one behind it.
TEST(Leak, IsATermOfTheValveLag) {
  const double tau_s = 0.125, k = 0.8, u = 0.5, before = 0.3, gain = 1 / (1 + k * tau_s);
  const ActiveEffect lag = {"valve_lag", "all", {{"fill_time_constant_s", tau_s}, {"vent_time_constant_s", tau_s}}};
  for (const double tau_r_s : {0.02, 0.15}) {
    const ReplayResult run =
        replayWith(stepOf("rig", {before}, {u}), {lag, {"leak", "all", {{"leak_per_s", k}, {"regulator_time_constant_s", tau_r_s}}}});
    for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
      const double t = sinceStep(run.simulated.time_s[row]);
      EXPECT_NEAR(valuesOf(run, "pressure_0")[row], gain * (u + (before - u) * std::exp(-t * (1 / tau_s + k))), 1e-12);
    }
  }
}

/// The weaker the leak, the nearer to the lag alone, also with further lags: a fit can go there.
TEST(Leak, GoesOverIntoTheLagAlone) {
  for (const double ratio : {0.0, 0.6}) {
    const ActiveEffect lag = {
        "valve_lag", "muscle_0", {{"fill_time_constant_s", 0.09}, {"vent_time_constant_s", 0.06}, {"next_lag_ratio", ratio}}};
    const Recording commands = wavesFor("rig", 0.5);
    const ReplayResult alone = replayWith(commands, {lag}), weak = replayWith(commands, {lag, {"leak", "all", {{"leak_per_s", 1e-6}}}});
    for (std::size_t row = 0; row < commands.time_s.size(); ++row)
      EXPECT_NEAR(valuesOf(weak, "pressure_0")[row], valuesOf(alone, "pressure_0")[row], 1e-7);
  }
}

/// Two leaks of a muscle add up, and a lag that acts twice stays two lags.
TEST(Leak, AddsUp) {
  const Recording step = stepOf("rig", {0.3}, {0.5});
  const ReplayResult two = replayWith(step, {{"leak", "all", {{"leak_per_s", 1.0}}}, {"leak", "muscle_0", {{"leak_per_s", 0.5}}}}),
                     one = replayWith(step, {{"leak", "all", {{"leak_per_s", 1.5}}}});
  for (std::size_t row = 0; row < step.time_s.size(); ++row)
    EXPECT_NEAR(valuesOf(two, "pressure_0")[row], valuesOf(one, "pressure_0")[row], 1e-12);
  const std::map<std::string, Parameter::Value> lag = {{"fill_time_constant_s", 0.1}};
  const ReplayResult twice = replayWith(step, {{"valve_lag", "all", lag}, {"valve_lag", "muscle_0", lag}});
  const double t = 0.1;  // since the step; two equal lags leave (1 + t / tau) e^(-t / tau) of it
  EXPECT_NEAR(valuesOf(twice, "pressure_0")[20], 0.5 - 0.2 * 2 * std::exp(-1.0), 5e-4)
      << t << " s; the second lag takes what the first delivers as constant within an internal step";
}

/// A valve that only fills with a lag holds less than the command after every step; one that fills at once replaces what is lost.
TEST(Leak, BesideALagOfOneDirection) {
  const double tau_s = 0.1, k = 0.8, u = 0.3;
  const ActiveEffect leak = {"leak", "all", {{"leak_per_s", k}}};
  const Recording down = stepOf("rig", {0.5}, {u}, 2.0);
  const ReplayResult fills = replayWith(down, {{"valve_lag", "all", {{"fill_time_constant_s", tau_s}}}, leak}),
                     vents = replayWith(down, {{"valve_lag", "all", {{"vent_time_constant_s", tau_s}}}, leak});
  EXPECT_NEAR(valuesOf(fills, "pressure_0").back(), u / (1 + k * tau_s), 1e-6);
  EXPECT_NEAR(valuesOf(vents, "pressure_0").front(), 0.5, 1e-12);
  EXPECT_NEAR(valuesOf(vents, "pressure_0").back(), u, 1e-12);
}

/// A limited flow after the lag is no term of its balance: a leak behind it has its own valve.
TEST(Leak, BehindALimitedFlowHasItsOwnValve) {
  const double k = 2;
  const Recording step = stepOf("rig", {0.3}, {0.5}, 2.0);
  const ReplayResult run = replayWith(step, {{"valve_lag", "all", {{"fill_time_constant_s", 0.2}, {"vent_time_constant_s", 0.2}}},
                                             {"flow_limit", "all", {{"fill_rate_per_s", 100.0}}},
                                             {"leak", "all", {{"leak_per_s", k}, {"regulator_time_constant_s", 0.05}}}});
  EXPECT_NEAR(valuesOf(run, "pressure_0").front(), 0.3 / (1 + k * 0.05), 1e-9);
  EXPECT_NEAR(valuesOf(run, "pressure_0").back(), 0.5 / (1 + k * 0.05), 1e-4);
}

TEST(SupplyDroop, LimitsAllMusclesByTheirCommonDemand) {
  const double droop = 0.1;
  const ReplayResult run = replayWith(stepOf("elbow", {0.9, 0.2}, {0.9, 0.7}), {{"supply_droop", "all", {{"droop", droop}}}});
  for (std::size_t row = 0; row < run.simulated.time_s.size(); ++row) {
    const double t = run.simulated.time_s[row];
    const bool after = t > 0.0999;
    const double rise = after ? 0.5 / 0.2 * std::exp(-(t - 0.1) / 0.2) : 0;
    const double supply = 1 - droop * (rise + (after ? 0.8 : 0.55));
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], std::min(0.9, supply), 1e-9) << t;
    EXPECT_NEAR(valuesOf(run, "pressure_1")[row], std::min(after ? 0.7 : 0.2, supply), 1e-9) << t;
  }
}

TEST(VolumeCoupling, ConservesThePolytropicProductWhereTheValveIsSlow) {
  // In the pose as built, the rig's load starts in the middle of the range and falls or is pulled up.
  const double n = 1.3, atmosphere = 0.17;
  ReplayOptions options;
  options.initial_state = "built";
  const Recording commands = commandsFor("rig", 0.15, [](double) { return Action{0.5}; });
  options.effects = {{"volume_coupling", "all", {{"polytropic_exponent", n}, {"regulator_time_constant_s", 10.0}}}};
  const ReplayResult run = replayRecording(commands, options);
  auto product = [&](std::size_t row) {
    const double r = (valuesOf(run, "length_0_mm")[row] - 120) / 180;
    return (valuesOf(run, "pressure_0")[row] + atmosphere) * std::pow(2 - r * r, n);
  };
  const auto& length = valuesOf(run, "length_0_mm");
  EXPECT_GT(std::abs(length.back() - length.front()), 5);
  EXPECT_GT(std::abs(valuesOf(run, "pressure_0").back() - 0.5), 0.01);
  for (std::size_t row = 0; row < commands.time_s.size(); ++row) EXPECT_NEAR(product(row), product(0), 0.005 * product(0)) << row;
}

/// The valve lag takes the place of the effect's own valve.
TEST(VolumeCoupling, IsATermOfTheValveLag) {
  ReplayOptions options;
  options.initial_state = "built";
  const Recording commands = commandsFor("rig", 0.15, [](double) { return Action{0.5}; });
  const std::map<std::string, Parameter::Value> slow = {{"fill_time_constant_s", 5.0}, {"vent_time_constant_s", 5.0}};
  const ReplayResult own =
      replayWith(commands, {{"volume_coupling", "all", {{"polytropic_exponent", 1.3}, {"regulator_time_constant_s", 5.0}}}}, options);
  const ReplayResult shared = replayWith(
      commands,
      {{"valve_lag", "all", slow}, {"volume_coupling", "all", {{"polytropic_exponent", 1.3}, {"regulator_time_constant_s", 0.02}}}},
      options);
  EXPECT_GT(std::abs(valuesOf(own, "pressure_0").back() - 0.5), 0.01);
  for (std::size_t row = 0; row < commands.time_s.size(); ++row)
    EXPECT_NEAR(valuesOf(shared, "pressure_0")[row], valuesOf(own, "pressure_0")[row], 1e-12);
}

TEST(VolumeCoupling, VanishesWithAFastValve) {
  const Recording commands = wavesFor("rig", 0.3);
  const ReplayResult run =
      replayWith(commands, {{"volume_coupling", "all", {{"polytropic_exponent", 1.4}, {"regulator_time_constant_s", 1e-4}}}});
  for (std::size_t row = 1; row < commands.time_s.size(); ++row)
    EXPECT_NEAR(valuesOf(run, "pressure_0")[row], commands.signals[0].values[row - 1], 1e-3);
}

TEST(RegulatorTail, MakesAShareOfEachChangeLate) {
  const std::vector<ActiveEffect> tail = {{"regulator_tail", "all", {{"share", 0.1}, {"time_constant_s", 0.2}}}};
  const ReplayResult filling = replayWith(stepOf("rig", {0.3}, {0.5}), tail), venting = replayWith(stepOf("rig", {0.5}, {0.3}), tail);
  for (std::size_t row = 0; row < filling.simulated.time_s.size(); ++row) {
    const double time_s = filling.simulated.time_s[row], t = sinceStep(time_s), left = 0.1 * 0.2 * std::exp(-t / 0.2);
    if (std::abs(time_s - 0.1) < 1e-4) continue;  // the row of the step itself
    EXPECT_NEAR(valuesOf(filling, "pressure_0")[row], time_s < 0.1 ? 0.3 : 0.5 - left, 1e-12);
    EXPECT_NEAR(valuesOf(venting, "pressure_0")[row], time_s < 0.1 ? 0.5 : 0.3 + left, 1e-12);
  }
}

TEST(PressureCalibration, IsAStraightLineAboveZero) {
  const std::vector<ActiveEffect> calibration = {{"pressure_calibration", "all", {{"gain", 0.9}, {"offset", -0.05}}}};
  const ReplayResult run = replayWith(stepOf("rig", {0.02}, {0.5}), calibration);
  EXPECT_EQ(valuesOf(run, "pressure_0").front(), 0);
  EXPECT_DOUBLE_EQ(valuesOf(run, "pressure_0").back(), 0.9 * 0.5 - 0.05);
}

}  // namespace
}  // namespace musclesim
