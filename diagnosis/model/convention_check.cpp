#include "convention_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "../data/data_checks.h"
#include "musclesim/base/error.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/actuator.h"
#include "musclesim/robot/robot.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {

namespace {

constexpr double thousand_low = 300, thousand_high = 3000;  ///< about a thousand
constexpr double radian_low = 30, radian_high = 170;        ///< 180 / pi = 57.3, beside friction that takes two thirds of the motion
constexpr double turn_deg = 360, about_turn_deg = 60, longest_row_s = 0.1;  ///< of a jump; in longer rows a joint may turn so far
constexpr double shortest_s = 0.1;                                          ///< no machine answers within less
constexpr double nearly_all = 0.95;                                         ///< share of the readings
constexpr double beyond_stops_deg = 10;                                     ///< more than soft stops give way
constexpr double beyond_length = 0.1;      ///< of the shortest and the longest length: more than an attachment is off
constexpr double beyond_full_scale = 0.3;  ///< of it: more than pressures overshoot
constexpr double atmosphere_kPa = 101.3, about_atmosphere_kPa = 10;
constexpr double hardly_open = 0.05, much_more = 10;  ///< of full scale, at which muscles pull next to nothing; motion over the model's
constexpr double unlike = 3;              ///< times that another signal moves more or less than in its model: then no unit is wrong
constexpr double follows_from = 0.8;      ///< correlation
constexpr double of_a_wave = 0.97;        ///< correlation: a wave that is late by half a period seems reversed; nothing follows from it
constexpr double clearly = 0.5;           ///< share of the unexplained variance at which one correlation exceeds another
constexpr double visible_sigmas = 2;      ///< standard deviation of a signal that moves, over its noise floor
constexpr double longest_lag_s = 1;       ///< valves, loggers and buses are later than the model by less
constexpr double earliest_s = 0.2;        ///< a machine is earlier than its model by less: nothing moves before its command
constexpr double lag_step_s = 0.02;       ///< much shorter than what moves
constexpr double farthest_clock_s = 20;   ///< that a clock is off in which the motion is looked for
constexpr double same_motion = 0.95;      ///< correlation of one motion under two clocks, which differ by effects only
constexpr double much_clearer = 0.25;     ///< share of the unexplained variance that is left under the right clock
constexpr int fewest_turns = 8;           ///< about the mean: the few motions of a step or a ramp resemble their like at other times
constexpr double shortest_overlap = 0.4;  ///< of a recording

/// Whether a correlation speaks clearly for a signal: it is large, and leaves far less unexplained than the other one does.
bool exceeds(double one, double other) {
  return one >= follows_from && other <= of_a_wave && 1 - one * one <= clearly * (1 - other * other);
}

/// Correlations of a measured signal with a predicted one, over lags of the measured one.
struct Correlation {
  double highest = 0, lowest = 0;  ///< highest >= 0, lowest <= 0
  double ratio = 0;                ///< of the standard deviations, measured over predicted
  bool follows() const { return exceeds(highest, -lowest); }
  bool isReversed() const { return exceeds(-lowest, highest); }
};

/// Sums over rows of two series from which their correlation follows.
struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(double a, double b) { n += 1, x += a, y += b, xx += a * a, xy += a * b, yy += b * b; }
  double ofX() const { return n > 0 ? xx - x * x / n : 0; }
  double ofY() const { return n > 0 ? yy - y * y / n : 0; }
  double ofBoth() const { return n > 0 ? xy - x * y / n : 0; }
};

class ConventionCheck {
 public:
  ConventionCheck(const Plant& plant, const std::vector<Prediction>& nominal) : plant_(plant), nominal_(nominal) {}

  void requireSeconds() const {
    for (int r = 0; r < static_cast<int>(plant_.recordings().size()); ++r) {
      const std::vector<double>& time_s = plant_.recordings()[index(r)].time_s;
      if (time_s.back() - time_s.front() < shortest_s)
        refuse(r, fmt::format("it lasts {:.3g} s: is its clock in seconds?", time_s.back() - time_s.front()));
    }
  }

  void requireThousands() const {
    forEachReading([&](int signal, int recording) {
      const double measured = medianSize(plant_.measured(recording, signal)), predicted = medianSize(predictedOf(recording, signal));
      if (measured <= 0 || predicted <= plant_.signals()[index(signal)].sigma.value) return;
      const double ratio = measured / predicted;
      if (measured < visible_sigmas * plant_.signals()[index(signal)].sigma.value) return;  // it rests at its zero
      for (const double factor : {ratio, 1 / ratio})
        if (factor > thousand_low && factor < thousand_high)
          refuse(recording,
                 fmt::format("{} is about {:.3g}, but must be in the unit of its name: the model's values are about {:.3g}, which "
                             "is about a thousand times {}",
                             nameOf(signal), measured, predicted, ratio > 1 ? "less" : "more"));
    });
  }

  /// Refuses an angle that begins again after a turn.
  void requireUnwrapped() const {
    forEachReading([&](int signal, int recording) {
      if (!nameOf(signal).starts_with("angle_")) return;
      const std::vector<double>&y = plant_.measured(recording, signal), &time_s = plant_.recordings()[index(recording)].time_s;
      int count = 0;
      double first_s = 0;
      for (std::size_t row = 1; row < y.size(); ++row) {
        const double jump_deg = std::abs(y[row] - y[row - 1]);
        if (!(std::abs(jump_deg - turn_deg) < about_turn_deg) || time_s[row] - time_s[row - 1] > longest_row_s) continue;
        if (count++ == 0) first_s = time_s[row];
      }
      if (count > 0)
        refuse(recording, fmt::format("{} jumps by about a turn from one row to the next at {:.2f} s{}: its sensor begins again after 360 "
                                      "degrees, but the angle must count on (in a mapping: unwrap = 360)",
                                      nameOf(signal), first_s, count > 1 ? fmt::format(", {} times in all", count) : ""));
    });
  }

  /// Refuses an angle in radians, in all recordings or in one. A machine that friction holds moves as little, but in all its signals and
  /// with the same noise as elsewhere.
  void requireDegrees() const {
    forEachReading([&](int signal, int recording) {
      if (!nameOf(signal).starts_with("angle_")) return;
      for (const Of which : {Of::all, Of::one}) {
        const Correlation with_model = correlation(signal, signal, which, recording);
        const double size = std::max(with_model.ratio, 1 / with_model.ratio);
        if (!(with_model.follows() || with_model.isReversed()) || !(size > radian_low && size < radian_high)) continue;
        const std::vector<double> others = ratiosOfOtherMotions(signal, which, recording);
        const bool moves_so = std::ranges::any_of(others, [](double ratio) { return ratio < 1 / unlike || ratio > unlike; });
        if ((moves_so && !areAllInRadians(others)) || (others.empty() && which == Of::one && !hasOtherNoise(signal, recording))) continue;
        refuse(recording,
               fmt::format("{} moves {:.0f} times {} than in the model: it must be in degrees, not in rad (1 rad is 57.3 degrees)",
                           nameOf(signal), size, with_model.ratio < 1 ? "less" : "more"));
      }
    });
  }

  void requireZeros() const {
    for (const Robot::Angle& angle : plant_.model().robot().angles()) {
      const auto [low, high] = angle.joint->stopsDeg(angle.axis);
      requireWithin("angle_" + angle.name + "_deg", low, high, beyond_stops_deg, beyond_stops_deg, "deg",
                    "where the joint has its stops: what is its zero?");
    }
    for (int m = 0; m < plant_.muscleCount(); ++m) {
      const auto [shortest, longest] = plant_.muscleRange(m);
      requireWithin(fmt::format("length_{}_mm", m), shortest, longest, beyond_length * shortest, beyond_length * longest, "mm",
                    "which is how long the muscle can be: is it a stroke, or another zero?");
    }
    for (int m = 0; m < plant_.muscleCount(); ++m)
      requireWithin(fmt::format("pressure_{}", m), 0, 1, beyond_full_scale, beyond_full_scale, "of full scale",
                    "as fractions of full scale do: is it in bar or kPa (pressure_0_bar, pressure_0_kPa)?");
    requireGaugePressures();
  }

  /// Refuses a signal that follows the model under a clock that is off by more than machines are late or early.
  void requireClocks() const {
    forEachReading([&](int signal, int recording) {
      if (!(goesWithJoints(signal) || nameOf(signal).starts_with("pressure_"))) return;
      const std::vector<double>&y = plant_.measured(recording, signal), &x = predictedOf(recording, signal);
      const std::vector<double>& time_s = plant_.recordings()[index(recording)].time_s;
      const double duration_s = time_s.back() - time_s.front();
      const auto at = [&](int lag) {  // correlation; nothing if too few rows overlap
        if (std::abs(lag) * lag_step_s > (1 - shortest_overlap) * duration_s) return 0.0;
        const Sums sums = lag >= 0 ? sumsOf(time_s, x, y, lag) : sumsOf(time_s, y, x, -lag);
        const double squares = sums.ofX() * sums.ofY();
        return squares > 0 ? sums.ofBoth() / std::sqrt(squares) : 0.0;
      };
      if (!movesVisibly(signal, sumsOf(time_s, y, x, 0)) || std::min(turnsOf(x, signal), turnsOf(y, signal)) < fewest_turns) return;
      const int late = static_cast<int>(std::lround(longest_lag_s / lag_step_s)),
                early = static_cast<int>(std::lround(earliest_s / lag_step_s)), farthest = static_cast<int>(farthest_clock_s / lag_step_s);
      double usual = 0, best = 0;
      int best_lag = 0;
      for (int lag = -early; lag <= late; ++lag) usual = std::max(usual, std::abs(at(lag)));
      for (int lag = -farthest; lag <= farthest; ++lag)
        if (const double r = at(lag); r > best) best = r, best_lag = lag;
      const bool is_early = best_lag < -early && best_lag >= -late;  // neighbouring lags resemble each other, so that some may follow, too
      if ((usual >= follows_from && !is_early) || best < same_motion || 1 - best * best > much_clearer * (1 - usual * usual)) return;
      refuse(recording, fmt::format("{} moves as in the model, but {:.1f} s {}: do its clock and that of the commands begin together?",
                                    nameOf(signal), std::abs(best_lag) * lag_step_s, best_lag > 0 ? "later" : "earlier"));
    });
  }

  /// Refuses a recording in which a signal is reversed, or two pressures are exchanged, while they are right in the others: a machine is
  /// one and the same.
  void requireLikeTheOthers() const {
    forEachReading([&](int signal, int recording) {
      if (goesWithJoints(signal) && correlation(signal, signal, Of::one, recording).isReversed() &&
          correlation(signal, signal, Of::others, recording).follows())
        refuse(recording, fmt::format("{} moves opposite to the model there, but not in the other recordings: has its sign changed? In a "
                                      "mapping, factor = -1 reverses a column",
                                      nameOf(signal)));
      for (int other = 0; other < signal; ++other) {
        if (!nameOf(signal).starts_with("pressure_") || !nameOf(other).starts_with("pressure_")) continue;
        const auto crossed = [&](Of which) {
          return std::min(correlation(signal, other, which, recording).highest, correlation(other, signal, which, recording).highest);
        };
        const auto own = [&](Of which) {
          return std::max(correlation(signal, signal, which, recording).highest, correlation(other, other, which, recording).highest);
        };
        if (exceeds(crossed(Of::one), own(Of::one)) && exceeds(own(Of::others), crossed(Of::others)))
          refuse(recording,
                 fmt::format("{} follows the model's {} there and the other way round, but not in the other recordings: are the two "
                             "columns exchanged?",
                             nameOf(signal), nameOf(other)));
      }
    });
  }

  /// Refuses commands that hardly open a valve while the machine moves.
  void requireFullScale() const {
    forEachReading([&](int signal, int recording) {
      if (!goesWithJoints(signal)) return;
      double largest = 0;
      for (const Signal& command : plant_.recordings()[index(recording)].signals)
        for (std::size_t row = 0; command.name.starts_with("command_") && row < command.values.size(); ++row)
          if (std::isfinite(command.values[row])) largest = std::max(largest, command.values[row]);
      if (largest > hardly_open) return;
      const Sums sums = sumsOf(recording, signal, signal, 0);  // x predicted, y measured
      const double noise = visible_sigmas * plant_.signals()[index(signal)].sigma.value;
      if (!(sums.n > 0) || sums.ofY() < sums.n * noise * noise || sums.ofY() < much_more * much_more * sums.ofX()) return;
      refuse(recording,
             fmt::format("commands stay below {:.2g} % of full scale, at which the model moves {} by {:.2g} (standard deviation), but "
                         "{:.2g} was measured: are commands and pressures in the unit of their names (bar or MPa, not kPa)?",
                         100 * largest, nameOf(signal), std::sqrt(sums.ofX() / sums.n), std::sqrt(sums.ofY() / sums.n)));
    });
  }

  /// Notes on signs.
  std::vector<std::string> requireSignsAndOrder() const {
    const std::vector<std::string> reversed = namesOf([&](int i) { return goesWithJoints(i) && correlation(i, i).isReversed(); });
    const std::vector<std::string> followed = namesOf([&](int i) { return goesWithJoints(i) && correlation(i, i).follows(); });
    const auto of_commands = [&](int i) { return nameOf(i).starts_with("pressure_"); };
    const auto right_pressures = namesOf([&](int i) { return of_commands(i) && correlation(i, i).follows(); });
    const bool commands_are_right = plant_.muscleCount() == 1 || static_cast<int>(right_pressures.size()) == plant_.muscleCount();
    if (!followed.empty() && reversed.empty()) requireOrder("pressure_", fmt::format(", while {} as the commands say", moves(followed)));
    if (commands_are_right) {
      const std::string why = right_pressures.empty() ? "" : ", although the pressures follow the commands";
      requireOrder("angle_", why);
      // The lengths of two antagonists are each other's opposite.
      if (std::ranges::none_of(reversed, isAngle))
        for (const char* kind : {"length_", "force_"}) requireOrder(kind, why);
      if (!reversed.empty())
        refuse(0, fmt::format("{} opposite to the model{}. Is its sign that of the model (angles turn right-handed about the joint's axis; "
                              "lengths, not contractions)? In a mapping, factor = -1 reverses a column. Or do hoses lead to other muscles "
                              "than the robot file says?",
                              moves(reversed), why));
    } else if (!reversed.empty()) {
      return {
          fmt::format("{} opposite to the model: either the commands, or the hoses of the muscles, are exchanged, or its sign is not that "
                      "of the model",
                      moves(reversed))};
    }
    return {};
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int signalCount() const { return static_cast<int>(plant_.signals().size()); }
  const std::string& nameOf(int signal) const { return plant_.signals()[index(signal)].name; }
  const std::vector<double>& predictedOf(int recording, int signal) const { return nominal_[index(recording)].values[index(signal)]; }
  static bool isAngle(const std::string& name) { return name.starts_with("angle_"); }
  /// Whether a signal goes one way where a joint does. The hand does not: where an arm swings through the vertical, its hand is highest at
  /// both ends, so that a smaller swing may look reversed. Nor does tension.
  bool goesWithJoints(int signal) const { return isAngle(nameOf(signal)) || nameOf(signal).starts_with("length_"); }

  static std::string moves(const std::vector<std::string>& names) {
    return fmt::format("{} {}", fmt::join(names, ", "), names.size() > 1 ? "move" : "moves");
  }

  [[noreturn]] void refuse(int recording, const std::string& what) const {
    throw BadFile(plant_.recordings()[index(recording)].file, what + " (--trust-columns takes the recordings as they are.)");
  }

  template <typename Use>
  void forEachReading(Use&& use) const {
    for (int r = 0; r < static_cast<int>(plant_.recordings().size()); ++r)
      for (int i = 0; i < signalCount(); ++i)
        if (!plant_.measured(r, i).empty() && !nominal_[index(r)].values.empty()) use(i, r);
  }

  template <typename Holds>
  std::vector<std::string> namesOf(Holds&& holds) const {
    std::vector<std::string> names;
    for (int i = 0; i < signalCount(); ++i)
      if (holds(i)) names.push_back(nameOf(i));
    return names;
  }

  enum class Of { all, one, others };  ///< recordings: all, a given one, or all but that

  /// Zero if the model does not move its signal visibly, or the measured one never changes.
  Correlation correlation(int measured, int predicted, Of which = Of::all, int given = 0) const {
    Correlation result;
    for (int lag = 0; lag * lag_step_s <= longest_lag_s; ++lag) {
      double xx = 0, xy = 0, yy = 0, n = 0;
      forEachReading([&](int signal, int recording) {
        if (signal != measured || (which != Of::all && (recording == given) != (which == Of::one))) return;
        const Sums sums = sumsOf(recording, measured, predicted, lag);
        xx += sums.ofX(), xy += sums.ofBoth(), yy += sums.ofY(), n += sums.n;
      });
      const auto isVisible = [&](double squares, int signal) {
        return squares > n * std::pow(visible_sigmas * plant_.signals()[index(signal)].sigma.value, 2);
      };
      if (!(n > 0) || !isVisible(xx, predicted) || (lag == 0 && yy == 0)) return {};
      const double r = xy / std::sqrt(xx * yy);
      if (std::abs(r) > std::max(result.highest, -result.lowest)) result.ratio = std::sqrt(yy / xx);
      result.highest = std::max(result.highest, r);
      result.lowest = std::min(result.lowest, r);
    }
    return result;
  }

  /// Whether only angles were recorded, and the others, too, move as much less or more as radians make it. Friction would not hold all
  /// joints by one factor.
  bool areAllInRadians(const std::vector<double>& others) const {
    for (int signal = 0; signal < signalCount(); ++signal)
      if (isMotion(nameOf(signal)) && !nameOf(signal).starts_with("angle_")) return false;
    return std::ranges::all_of(others, [](double ratio) {
      const double size = std::max(ratio, 1 / ratio);
      return size > radian_low && size < radian_high;
    });
  }

  /// How much the other lengths, angles and coordinates of the hand that the model moves were moved, measured over predicted.
  std::vector<double> ratiosOfOtherMotions(int signal, Of which, int recording) const {
    std::vector<double> ratios;
    for (int other = 0; other < signalCount(); ++other) {
      if (other == signal || !isMotion(nameOf(other))) continue;
      if (const double ratio = correlation(other, other, which, recording).ratio; ratio > 0) ratios.push_back(ratio);
    }
    return ratios;
  }

  /// Whether the noise of a signal differs from that in the other recordings by as much as another unit makes it.
  bool hasOtherNoise(int signal, int recording) const {
    const auto noiseIn = [&](int which) {
      Recording alone = plant_.recordings()[index(which)];
      alone.info.noise_std.clear();
      const NoiseSigma sigma = noiseSigma({alone}, nameOf(signal));
      return sigma.source == NoiseSigma::Source::quiet_rows ? sigma.value : 0;
    };
    const double here = noiseIn(recording);
    std::vector<double> elsewhere;
    for (int other = 0; other < static_cast<int>(plant_.recordings().size()); ++other)
      if (other != recording && plant_.recordings()[index(other)].find(nameOf(signal))) elsewhere.push_back(noiseIn(other));
    const double there = medianSize(elsewhere);
    return here > 0 && there > 0 && std::max(here / there, there / here) > much_more;
  }

  /// How often the values of a signal, measured or predicted, pass their mean by more than the noise.
  int turnsOf(const std::vector<double>& values, int signal) const {
    const double noise = visible_sigmas * plant_.signals()[index(signal)].sigma.value;
    double sum = 0, count = 0, last = 0;
    for (const double value : values)
      if (std::isfinite(value)) sum += value, ++count;
    int turns = 0;
    for (const double value : values) {
      const double above = value - sum / count;
      if (!std::isfinite(above) || std::abs(above) <= noise) continue;
      turns += above * last < 0 ? 1 : 0;
      last = above;
    }
    return turns;
  }

  /// Whether the measured and the predicted signal, y and x of the sums or the other way round, move by more than the noise.
  bool movesVisibly(int signal, const Sums& sums) const {
    return std::min(sums.ofX(), sums.ofY()) > sums.n * std::pow(visible_sigmas * plant_.signals()[index(signal)].sigma.value, 2);
  }

  /// Of one recording: predicted x and measured y.
  Sums sumsOf(int recording, int measured, int predicted, int lag) const {
    return sumsOf(plant_.recordings()[index(recording)].time_s, predictedOf(recording, predicted), plant_.measured(recording, measured),
                  lag);
  }

  /// x and, `lag` steps of lag_step_s later, y.
  static Sums sumsOf(const std::vector<double>& time_s, const std::vector<double>& x, const std::vector<double>& y, int lag) {
    Sums sums;
    std::size_t earlier = 0;
    double last_s = -lag_step_s;
    for (std::size_t row = 0; row < std::min(x.size(), y.size()); ++row) {
      if (time_s[row] < last_s + lag_step_s * (1 - 1e-9)) continue;
      last_s = time_s[row];
      while (earlier < row && time_s[earlier + 1] <= time_s[row] - lag * lag_step_s + 1e-9) ++earlier;
      if (time_s[row] - time_s[0] < lag * lag_step_s - 1e-9) continue;
      if (std::isfinite(y[row]) && std::isfinite(x[earlier])) sums.add(x[earlier], y[row]);
    }
    return sums;
  }

  void requireWithin(const std::string& name, double low, double high, double below, double above, const char* unit,
                     const char* why) const {
    if (!std::isfinite(low) || !std::isfinite(high)) return;
    forEachReading([&](int signal, int recording) {
      if (nameOf(signal) != name) return;
      std::vector<double> values;
      std::ranges::copy_if(plant_.measured(recording, signal), std::back_inserter(values), [](double v) { return std::isfinite(v); });
      const auto beyond = std::ranges::count_if(values, [&](double v) { return v < low - below || v > high + above; });
      if (values.empty() || static_cast<double>(beyond) < nearly_all * static_cast<double>(values.size())) return;
      const auto [least, most] = std::ranges::minmax(values);
      refuse(recording,
             fmt::format("{} lies in {:.4g} .. {:.4g} {}, and not in {:.4g} .. {:.4g}, {}", name, least, most, unit, low, high, why));
    });
  }

  void requireGaugePressures() const {
    const auto full_scale_kPa = plant_.recordings().front().info.pressure_full_scale_kPa;
    if (!full_scale_kPa) return;
    forEachReading([&](int signal, int recording) {
      if (!nameOf(signal).starts_with("pressure_")) return;
      const std::vector<double>&y = plant_.measured(recording, signal), &x = predictedOf(recording, signal);
      std::vector<double> differences;
      for (std::size_t row = 0; row < std::min(x.size(), y.size()); ++row)
        if (std::isfinite(y[row]) && std::isfinite(x[row])) differences.push_back(y[row] - x[row]);
      if (differences.empty()) return;
      const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
      std::ranges::nth_element(differences, middle);
      const double above = *middle, above_kPa = above * *full_scale_kPa;
      if (std::abs(above_kPa - atmosphere_kPa) > about_atmosphere_kPa) return;
      const auto alike =
          std::ranges::count_if(differences, [&](double d) { return std::abs(d - above) * *full_scale_kPa < about_atmosphere_kPa; });
      if (2 * alike < std::ssize(differences) && !correlation(signal, signal).follows()) return;  // another muscle's pressure
      refuse(recording, fmt::format("{} is {:.0f} kPa above the command, about one atmosphere: it must be the pressure above that of the "
                                    "atmosphere, not the absolute one (in a mapping: offset = {:.4g} for bar, {:.4g} for kPa)",
                                    nameOf(signal), above_kPa, -atmosphere_kPa / kPa_per_bar, -atmosphere_kPa));
    });
  }

  /// Refuses two signals of a kind that follow each other's model.
  void requireOrder(const std::string& kind, const std::string& why) const {
    for (int i = 0; i < signalCount(); ++i)
      for (int k = i + 1; k < signalCount(); ++k) {
        if (!nameOf(i).starts_with(kind) || !nameOf(k).starts_with(kind)) continue;
        const double crossed = std::min(correlation(i, k).highest, correlation(k, i).highest);
        const double own = std::max(correlation(i, i).highest, correlation(k, k).highest);
        if (!exceeds(crossed, own)) continue;
        refuse(0, fmt::format("{} follows the model's {}, and {} the model's {}{}: are the two columns exchanged?", nameOf(i), nameOf(k),
                              nameOf(k), nameOf(i), why));
      }
  }

  const Plant& plant_;
  const std::vector<Prediction>& nominal_;
};

}  // namespace

std::vector<std::string> checkConventions(const Plant& plant, const std::vector<Prediction>& nominal) {
  const ConventionCheck check(plant, nominal);
  check.requireSeconds();
  check.requireThousands();
  check.requireUnwrapped();
  check.requireFullScale();
  check.requireDegrees();
  check.requireZeros();
  check.requireLikeTheOthers();
  check.requireClocks();
  return check.requireSignsAndOrder();
}

}  // namespace musclesim
