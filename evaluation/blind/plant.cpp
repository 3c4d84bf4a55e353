#include "plant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "chance.h"
#include "contribution.h"
#include "machine.h"
#include "musclesim/base/error.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::blind {

namespace {

/// NaN if one is NaN: the plant diverges.
double largestOf(const std::map<std::string, double>& over_noise) {
  double largest = 0;
  for (const auto& [signal, value] : over_noise) {
    if (!std::isfinite(value)) return value;
    largest = std::max(largest, value);
  }
  return largest;
}

/// Draws the causes of a plant whose plan, numbers and truth are drawn.
class CauseDraw {
 public:
  CauseDraw(const PlantRequest& request, const Robot& robot, Plant& plant, RandomStream& random)
      : request_(request), robot_(robot), plant_(plant), random_(random) {}

  /// False if it was interrupted.
  bool draw() {
    constexpr double machine_share = 0.5;
    constexpr int most_rounds = 3;
    const Kind& kind = plant_.plan.kind;
    const int known_count =
        kind.least_known + static_cast<int>(indexBelow(random_, static_cast<std::size_t>(kind.most_known - kind.least_known + 1)));
    plant_.machine = kind.isSeveral() && request_.causes.empty() && happens(random_, machine_share);
    if (plant_.machine)
      for (Cause& cause : drawMachine(known_count, robot_, random_)) plant_.causes.push_back({.cause = std::move(cause)});
    while (static_cast<int>(plant_.causes.size()) < known_count)
      if (!add(false)) return false;
    if (kind.unknown && !add(true)) return false;
    weigh();
    for (int round = 0; round < most_rounds && !plant_.causes.empty(); ++round)
      if (!replaceWeak()) return false;
    return true;
  }

 private:
  std::vector<Cause> others(std::size_t left_out) const {
    std::vector<Cause> causes;
    for (std::size_t i = 0; i < plant_.causes.size(); ++i)
      if (i != left_out) causes.push_back(plant_.causes[i].cause);
    return causes;
  }

  bool add(bool unknown) {
    auto cause = drawn(unknown, plant_.causes.size());
    if (cause) plant_.causes.push_back({.cause = std::move(*cause)});
    return cause.has_value();
  }

  /// Tries laws for the cause in one place of the list until one reaches the plant's size. Empty if interrupted.
  std::optional<Cause> drawn(bool unknown, std::size_t place) {
    constexpr std::size_t most_draws = 60, draws_in_a_row = 3, far_apart = 10;  // far_apart: laws between one cause and the next
    const Plan& plan = plant_.plan;
    const auto laws = lawsInTurn(robot_, plan.signals, unknown, request_.causes, request_.seed, request_.turn + far_apart * place);
    for (std::size_t draw = 0; draw < most_draws && !laws.empty(); ++draw) {
      const OutOfCatalogueLaw& law = laws[draw / draws_in_a_row % laws.size()];
      const bool others_left = laws.size() > plant_.causes.size();
      const bool too_weak = others_left && place < plant_.causes.size() && plant_.causes[place].cause.law.id == law.info.id;
      if (too_weak || !canActBeside(law, others(place))) continue;
      if (plan.kind.isSeveral() && law.stands_for == "channel_swap") continue;  // would hide all others
      const std::string component = oneOf(random_, componentsOf(law, robot_, plan.signals));
      if (request_.interrupted()) return {};
      if (auto cause = causeOfSize(law, component, plan.size, plant_.truth, random_)) return cause;
      plant_.redrawn.push_back(law.info.id + "@" + component);
    }
    throw BadParameter(plan.name + ": size of the gap", plan.size,
                       fmt::format("be reached by one of {} drawn causes; take another seed, or other --causes", most_draws));
  }

  std::map<std::string, double> overNoise(std::map<std::string, double> rmse) const {
    for (auto& [signal, value] : rmse) value /= plant_.truth.noiseStd().at(signal);
    return rmse;
  }

  /// The motion under all causes; empty if they make no body together, as a load that is lifted off from one that is light already.
  Truth::Motion motionOfAll() const {
    try {
      return plant_.truth.motion(lawsOf(plant_.causes));
    } catch (const BadParameter&) {
    } catch (const BadFile&) {
    }
    return {};
  }

  /// Measures what each cause contributes: nothing (NaN) if the plant cannot be simulated.
  void weigh() {
    const Truth& truth = plant_.truth;
    plant_.motion = motionOfAll();
    for (PlantCause& one : plant_.causes) one.contribution_over_noise = std::numeric_limits<double>::quiet_NaN();
    if (plant_.motion.empty()) return;
    const auto gap = overNoise(truth.rmse(truth.model(), plant_.motion));
    for (std::size_t i = 0; i < plant_.causes.size(); ++i) {
      PlantCause& one = plant_.causes[i];
      std::vector<ActiveEffect> laws;
      for (const Cause& other : others(i)) laws.push_back(other.law);
      one.contribution = contributionBeside(laws, plant_.motion, truth, plant_.numbers);
      one.contribution_over_noise = largestOf(one.contribution);
      one.demanded = isDemanded(one.contribution, gap, plant_.causes.size());
    }
  }

  /// An unknown cause must be large enough to be told.
  static bool isWeak(const PlantCause& one) { return !(one.contribution_over_noise >= 1) || (one.cause.isUnknown() && !one.demanded); }

  /// Draws causes that are too weak, or with which the plant diverges, again. False if interrupted.
  bool replaceWeak() {
    bool changed = false;
    for (std::size_t i = 0; i < plant_.causes.size(); ++i) {
      PlantCause& one = plant_.causes[i];
      if (!isWeak(one)) continue;
      plant_.redrawn.push_back(one.cause.law.id + "@" + one.cause.component);
      auto cause = one.cause.measured ? drawnAgain(one.cause, random_) : drawn(one.cause.isUnknown(), i);
      if (!cause) return false;
      one.cause = std::move(*cause);
      changed = true;
    }
    if (changed) weigh();
    return true;
  }

  const PlantRequest& request_;
  const Robot& robot_;
  Plant& plant_;
  RandomStream& random_;
};

/// The truth of a plan with these numbers; nothing if they make no body: a heavy forearm with a small inertia.
std::optional<Truth> truthOf(const Plan& plan, const NumberErrors& numbers, std::uint64_t seed) {
  try {
    return Truth(plan.recordings, plan.signals, plan.noise_std, seed, numbers.truth);
  } catch (const BadParameter&) {
  } catch (const BadFile&) {
  }
  return std::nullopt;
}

/// Redraws while a finer time step alone makes more than half the noise: such a plant would have a gap that its cause does not explain.
/// Also redraws where the numbers make no body.
Plant drawWithoutCauses(const PlantRequest& request, const Robot& robot, RandomStream& random) {
  constexpr double most_over_noise = 0.5;
  constexpr int most_draws = 20;
  for (int draw = 0; draw < most_draws; ++draw) {
    Plan plan = drawPlan(request.name, request.robot, robot, request.kinds, request.duration_s, random);
    NumberErrors numbers = drawNumbers(plan.recordings.front(), random);
    if (request.exact_numbers) numbers.truth = {}, numbers.scale = 0;
    const auto seed = static_cast<std::uint64_t>(random.uniform(0, 9e15));
    std::optional<Truth> truth = truthOf(plan, numbers, seed);
    if (!truth) continue;
    const double gap_of_step = truth->gapOverNoise(truth->rmse(truth->model(), truth->nominalMotion({})));
    if (gap_of_step <= most_over_noise)
      return {.plan = std::move(plan), .numbers = std::move(numbers), .truth = std::move(*truth), .gap_of_step_over_noise = gap_of_step};
  }
  throw BadParameter(request.name + ": excitations", fmt::format("{} draws", most_draws),
                     "include some in which the model agrees with itself at half its step; take another seed");
}

}  // namespace

bool isDemanded(const std::map<std::string, double>& contribution, const std::map<std::string, double>& gap, std::size_t cause_count) {
  constexpr double least_of_several = 3, least_alone = 1, least_share = 0.1;
  const double least = cause_count > 1 ? least_of_several : least_alone;
  return std::ranges::any_of(contribution, [&](const auto& one) { return one.second >= std::max(least, least_share * gap.at(one.first)); });
}

std::vector<ActiveEffect> lawsOf(const std::vector<PlantCause>& causes) {
  std::vector<ActiveEffect> laws;
  for (const PlantCause& one : causes) laws.push_back(one.cause.law);
  return laws;
}

std::optional<Plant> drawPlant(const PlantRequest& request) {
  RandomStream random(request.seed, "blind." + request.name);
  Simulation probe;
  const Robot& robot = probe.build(request.robot);
  Plant plant = drawWithoutCauses(request, robot, random);
  if (!CauseDraw(request, robot, plant, random).draw()) return {};
  const Truth& truth = plant.truth;
  if (plant.motion.empty() || !std::isfinite(truth.gapOverNoise(truth.rmse(truth.model(), plant.motion))))
    throw BadParameter(request.name + ": causes", fmt::format("{}", plant.causes.size()),
                       "make a plant that can be simulated; take another seed");
  return plant;
}

}  // namespace musclesim::blind
