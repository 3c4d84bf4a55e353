#include "cause.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "../../effect/components.h"
#include "chance.h"
#include "look_alikes.h"
#include "musclesim/base/error.h"
#include "musclesim/effect/relevance.h"
#include "musclesim/robot/robot.h"

namespace musclesim::blind {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool isMeasured(const std::string& component, const std::vector<std::string>& signals) {
  return std::ranges::any_of(signals, [&](const std::string& name) { return component == "signal_" + stemOf(name); });
}

double sign(RandomStream& random) {
  return happens(random, 0.5) ? 1 : -1;
}

double drawShape(const EffectParameter& p, RandomStream& random) {
  return p.usual_low > 0 ? logUniform(random, p.usual_low, p.usual_high) : random.uniform(p.usual_low, p.usual_high);
}

double drawSize(const EffectParameter& p, bool first, RandomStream& random) {
  constexpr double smallest_share = 0.1;
  if (countsBits(p)) return std::round(random.uniform(p.usual_low, p.usual_high));
  if (!std::isfinite(p.neutral)) return logUniform(random, p.usual_low, p.usual_high);
  const double below = p.neutral - p.usual_low, above = p.usual_high - p.neutral;
  if (below > 0 && above > 0) {
    const double side = sign(random);
    return p.neutral + side * (side > 0 ? above : below) * (first ? logUniform(random, smallest_share, 1) : random.uniform());
  }
  if (below == 0 && above == 0) return p.neutral;
  if (below < 0) return p.neutral + logUniform(random, -below, above);
  return p.neutral - logUniform(random, std::max(-above, smallest_share * below), below);
}

/// Largest distance of a size from neutral: three times the usual one.
bool isPlausible(const EffectParameter& p, double value) {
  constexpr double most = 3;
  if (value < p.minimum || value > p.maximum) return false;
  if (!std::isfinite(p.neutral)) return value >= p.usual_low / most;
  const double usual = std::max(std::abs(p.usual_low - p.neutral), std::abs(p.usual_high - p.neutral));
  return std::abs(value - p.neutral) <= most * usual;
}

/// The motion with one law alone. Empty for a law that cannot act on this component (a bracket needs a joint).
Truth::Motion motionUnder(const ActiveEffect& law, const Truth& truth) {
  try {
    return truth.motion({law});
  } catch (const BadParameter&) {
  } catch (const BadFile&) {  // a robot file that cannot be built with it: a muscle that would end within its pulley
  }
  return {};
}

/// Change that a law makes alone. NaN without a motion, and for a plant that diverges.
double gapOf(const Truth::Motion& motion, const Truth& truth) {
  return motion.empty() ? std::numeric_limits<double>::quiet_NaN() : truth.gapOverNoise(truth.rmse(truth.clean(), motion));
}

/// Whether a muscle's pressure is shut off in some of the rows that are fitted and delivered in others.
bool opensAndCloses(const Truth::Motion& motion, const std::string& pressure) {
  constexpr double least_share = 0.05;
  double shut = 0, delivered = 0;
  for (std::size_t i = 0; i + 1 < motion.size(); ++i)
    for (const double value : motion[i].find(pressure)->values) ++(value == 0 ? shut : delivered);
  return std::min(shut, delivered) >= least_share * (shut + delivered);
}

/// Whether a law does what its name says: a valve whose dead band the commands never leave, or never enter, has no dead band. Always true
/// for other laws.
bool showsItself(const OutOfCatalogueLaw& law, const std::string& component, const Truth::Motion& motion) {
  if (law.stands_for != "command_dead_band") return true;
  for (const Signal& signal : motion.front().signals) {
    const bool affected = component == "all" || component == "muscle_" + signal.name.substr(signal.name.find('_') + 1);
    if (signal.name.starts_with("pressure_") && affected && opensAndCloses(motion, signal.name)) return true;
  }
  return false;
}

}  // namespace

bool countsBits(const EffectParameter& parameter) {
  return parameter.unit == "bit";
}

const std::vector<std::string>& sizeNames() {
  static const std::vector<std::string> names = {"weak", "clear", "strong"};
  return names;
}

Band bandOf(const std::string& size, const std::string& stands_for) {
  static const std::map<std::string, Band> bands = {{"weak", {2, 6}}, {"clear", {6, 40}}, {"strong", {40, 200}}};
  const auto found = bands.find(size);
  if (found == bands.end()) throw BadParameter("size", size, "be one of weak, clear, strong");
  if (size == "strong" && stands_for == "channel_swap") return {found->second.low, infinity};
  return found->second;
}

bool canActBeside(const OutOfCatalogueLaw& law, const std::vector<Cause>& others) {
  static const std::set<std::string> one_valve = {"valve_lag", "flow_limit"};
  return std::ranges::all_of(others, [&](const Cause& other) {
    if (law.info.id == other.law.id) return false;
    return !areOfOneClass(law.stands_for, other.id) && !(one_valve.contains(law.stands_for) && one_valve.contains(other.id));
  });
}

std::vector<std::string> componentsOf(const OutOfCatalogueLaw& law, const Robot& robot, const std::vector<std::string>& signals) {
  std::vector<std::string> components = componentsFor(law.info, robot);
  if (law.info.stage == Stage::sensor) std::erase_if(components, [&](const std::string& c) { return !isMeasured(c, signals); });
  if (law.stands_for.empty()) return components;
  const EffectInfo stood_for = effectInfo(law.stands_for);
  const auto is_foreign_to = [&](const std::string& c) {
    return !stood_for.parameters.empty() && relevantParameters(stood_for, c).empty();
  };
  std::erase_if(components, is_foreign_to);
  return components;
}

std::vector<OutOfCatalogueLaw> lawsInTurn(const Robot& robot, const std::vector<std::string>& signals, bool open,
                                          const std::vector<std::string>& causes, std::uint64_t seed, std::size_t turn) {
  std::vector<OutOfCatalogueLaw> all = outOfCatalogueLaws();
  std::erase_if(all, [&](const OutOfCatalogueLaw& law) {
    const bool wanted = open || causes.empty() || std::ranges::find(causes, law.stands_for) != causes.end();
    return law.stands_for.empty() != open || !wanted;
  });
  RandomStream order(seed, "blind.order");
  for (std::size_t left = all.size(); left > 1; --left) std::swap(all[left - 1], all[indexBelow(order, left)]);
  std::vector<OutOfCatalogueLaw> laws;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const OutOfCatalogueLaw& law = all[(turn + i) % all.size()];
    if (!componentsOf(law, robot, signals).empty()) laws.push_back(law);
  }
  return laws;
}

std::vector<double> drawSizes(const EffectInfo& law, RandomStream& random) {
  std::vector<double> values;
  for (const EffectParameter& p : law.parameters) values.push_back(p.shape ? drawShape(p, random) : drawSize(p, values.empty(), random));
  return values;
}

std::optional<std::vector<double>> scaled(const EffectInfo& law, std::vector<double> values, double factor) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const EffectParameter& p = law.parameters[i];
    if (p.shape) continue;
    if (countsBits(p))
      values[i] = std::round(values[i] - std::log2(factor));
    else
      values[i] = std::isfinite(p.neutral) ? p.neutral + factor * (values[i] - p.neutral) : values[i] / factor;
    if (!isPlausible(p, values[i])) return std::nullopt;
  }
  return values;
}

std::optional<Cause> causeOfSize(const OutOfCatalogueLaw& law, const std::string& component, const std::string& size, const Truth& truth,
                                 RandomStream& random) {
  constexpr int draw_count = 10;
  constexpr double smallest_factor = 0.01, largest_factor = 4, no_gap = 0.02, largest_target = 5;
  const Band band = bandOf(size, law.stands_for);
  std::optional<std::vector<double>> values;
  for (int draw = 0; draw < draw_count; ++draw) {
    if (!values || draw % 4 == 0) values = drawSizes(law.info, random);
    Cause cause{.id = law.stands_for.empty() ? law.info.id : law.stands_for,
                .component = component,
                .law = activeEffect(law.info, component, *values),
                .stage = law.info.stage};
    const Truth::Motion motion = motionUnder(cause.law, truth);
    cause.gap_over_noise = gapOf(motion, truth);
    if (band.holds(cause.gap_over_noise) && showsItself(law, component, motion)) return cause;
    const double target = logUniform(random, band.low, std::min(band.high, largest_target * band.low));
    const bool scalable = std::isfinite(cause.gap_over_noise) && cause.gap_over_noise > no_gap && law.stands_for != "channel_swap";
    if (scalable)
      values = scaled(law.info, *values, std::clamp(target / cause.gap_over_noise, smallest_factor, largest_factor));
    else
      values.reset();
  }
  return std::nullopt;
}

}  // namespace musclesim::blind
