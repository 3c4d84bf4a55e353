#include "key.h"

#include <fmt/format.h>

#include "look_alikes.h"
#include "musclesim/robot/robot.h"

namespace musclesim::blind {

using nlohmann::json;

namespace {

json causeJson(const PlantCause& one) {
  const Cause& cause = one.cause;
  json parameters = json::object();
  for (const auto& [name, value] : cause.law.parameters) parameters[name] = std::get<double>(value);
  return {{"id", cause.id},
          {"component", cause.component},
          {"stage", nameOf(cause.stage)},
          {"known", !cause.isUnknown()},
          {"law", cause.law.id},
          {"law_parameters", parameters},
          {"gap_over_noise", cause.gap_over_noise},
          {"contribution_over_noise", one.contribution_over_noise},
          {"contribution_per_signal", one.contribution},
          {"demanded", one.demanded}};
}

json excitationsJson(const Plan& plan) {
  json list = json::array();
  for (std::size_t i = 0; i < plan.excitations.size(); ++i) {
    const Excitation& e = plan.excitations[i];
    list.push_back({{"file", fmt::format("r{}.csv", i + 1)},
                    {"excitation", e.kind},
                    {"amplitude", e.amplitude},
                    {"speed", e.speed},
                    {"held_out", i + 1 == plan.excitations.size()}});
  }
  return list;
}

/// The known causes' laws in the model against nothing in it, on the recording that measures the result.
double oracleReductionPercent(const Plant& plant) {
  constexpr double percent = 100;
  const Truth& truth = plant.truth;
  std::vector<ActiveEffect> known;
  for (const PlantCause& one : plant.causes)
    if (!one.cause.isUnknown()) known.push_back(one.cause.law);
  const auto gap = [&](const Truth::Motion& model) { return truth.normalisedGap(truth.rmse({model.back()}, {plant.motion.back()})); };
  return percent * (1 - gap(truth.nominalMotion(known)) / gap(truth.model()));
}

/// The size drawn for the causes; of a machine, whose causes have sizes of their own, that of the whole gap.
std::string sizeOf(const Plant& plant, double gap_over_noise) {
  if (!plant.machine) return plant.plan.size;
  for (const std::string& name : sizeNames())
    if (gap_over_noise < bandOf(name).high) return name;
  return sizeNames().back();
}

}  // namespace

json keyOf(const Plant& plant, const Robot& robot) {
  const Plan& plan = plant.plan;
  const Truth& truth = plant.truth;
  json effects = json::array(), acceptable = json::array(), stages = json::array();
  for (const PlantCause& one : plant.causes) {
    effects.push_back(causeJson(one));
    stages.push_back(nameOf(one.cause.stage));
    if (!one.cause.isUnknown()) acceptable.push_back(acceptableAnswers(one.cause.id, one.cause.component, plan.signals, robot));
  }
  const auto rmse = truth.rmse(truth.model(), plant.motion);
  const double gap = truth.gapOverNoise(rmse);
  json key = {{"robot", robot.name()},
              {"kind", plan.kind.name},
              {"size", sizeOf(plant, gap)},
              {"machine", plant.machine},
              {"verdict", plan.kind.verdict()},
              {"effects", effects},
              {"acceptable", acceptable},
              {"stages", stages},
              {"signals", plan.signals},
              {"noise_std", plan.noise_std},
              {"number_error_scale", plant.numbers.scale},
              {"numbers_nominal", plant.numbers.nominal},
              {"numbers_true", plant.numbers.truth},
              {"gap_over_noise", gap},
              {"gap_normalised", truth.normalisedGap(rmse)},
              {"gap_of_step_over_noise", plant.gap_of_step_over_noise},
              {"gap_of_numbers_over_noise", truth.gapOverNoise(truth.rmse(truth.model(), truth.clean()))},
              {"step_ratio", truth.stepRatio()},
              {"noise_free_rmse", rmse},
              {"recordings", excitationsJson(plan)},
              {"redrawn", plant.redrawn}};
  if (!acceptable.empty()) key["oracle_shrink_percent"] = oracleReductionPercent(plant);
  return key;
}

}  // namespace musclesim::blind
