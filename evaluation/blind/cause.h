/// Drawing a cause: which law, on which component, how strong.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../out_of_catalogue/out_of_catalogue.h"
#include "musclesim/base/random.h"
#include "truth.h"

namespace musclesim {
class Robot;
}

namespace musclesim::blind {

/// Largest RMSE of any signal over its noise that a cause of a size class makes: weak 2..6, clear 6..40, strong 40..200.
struct Band {
  double low = 0, high = 0;
  bool holds(double gap) const { return gap >= low && gap <= high; }
};
const std::vector<std::string>& sizeNames();
/// Throws BadParameter for another name. An exchange of channels has no size: it is strong, however large its gap.
Band bandOf(const std::string& size, const std::string& stands_for = "");

/// A cause with the law that simulates it.
struct Cause {
  std::string id;         ///< of the catalogue; the law's own for a cause that the catalogue does not have
  std::string component;  ///< of the robot
  ActiveEffect law;       ///< a foreign law; its parameters mean something else than the catalogue's
  Stage stage = Stage::command;
  double gap_over_noise = 0;  ///< that it alone makes
};

/// The laws that can act on this robot and on what is measured, in an order that the seed gives, from the `turn`-th on: over many turns all
/// come equally often. `open`: laws of causes that the catalogue does not have; otherwise those of `causes`, ids of the catalogue, or of
/// all if that is empty.
std::vector<OutOfCatalogueLaw> lawsInTurn(const Robot& robot, const std::vector<std::string>& signals, bool open,
                                          const std::vector<std::string>& causes, std::uint64_t seed, std::size_t turn);

/// The components of a law: those of the robot on which the cause that it stands for does something; of sensors only those that are read.
std::vector<std::string> componentsOf(const OutOfCatalogueLaw& law, const Robot& robot, const std::vector<std::string>& signals);

/// Sizes within the usual ranges: the first parameter log-uniform, signed where the range is, shapes anywhere in their range.
std::vector<double> drawSizes(const EffectInfo& law, RandomStream& random);
/// The same effect `factor` times as strong: all parameters but shapes move away from neutral. Nothing if that leaves what is accepted or
/// three times the usual range.
std::optional<std::vector<double>> scaled(const EffectInfo& law, std::vector<double> values, double factor);

/// Draws and scales sizes up to ten times until the gap lies in the band; nothing if it never does.
std::optional<Cause> causeOfSize(const OutOfCatalogueLaw& law, const std::string& component, const std::string& size, const Truth& truth,
                                 RandomStream& random);

}  // namespace musclesim::blind
