/// Draws a cause: which law acts, on which component, how strongly.
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

/// Range of the largest ratio of RMSE to noise of any signal that a cause of a size class makes: weak 2..6, clear 6..40, strong 40..200.
/// Throws BadParameter for another name. An exchange of channels has no size and counts as strong, however large its gap.
struct Band {
  double low = 0, high = 0;
  bool holds(double gap) const { return gap >= low && gap <= high; }
};
const std::vector<std::string>& sizeNames();
/// Throws BadParameter for another name. An exchange of channels has no size: it is strong, however large its gap.
Band bandOf(const std::string& size, const std::string& stands_for = "");

/// A cause with the law that simulates it.
struct Cause {
  std::string id;         ///< id of the catalogue; the law's own id for a cause that the catalogue does not have
  std::string component;  ///< of the robot
  ActiveEffect law;       ///< an out-of-catalogue law; its parameters differ in meaning from the catalogue's
  Stage stage = Stage::command;
  double gap_over_noise = 0;  ///< change that this cause makes alone; not drawn for measured sizes
  bool measured = false;      ///< its sizes are those of a real machine (machine.h)
  bool isUnknown() const { return law.id == id; }
};

/// Whether a plant that has the others can also have the cause of this law: no cause twice, none that some recordings cannot distinguish
/// from another one (areOfOneClass), not a lag and a rate limit of the same valve.
bool canActBeside(const OutOfCatalogueLaw& law, const std::vector<Cause>& others);

/// The laws that can act on this robot and change what is measured, in an order drawn from the seed, starting at the `turn`-th: over many
/// turns all are used equally often. `open`: laws of causes that the catalogue does not have; otherwise laws of `causes` (ids of the
/// catalogue; empty: all).
std::vector<OutOfCatalogueLaw> lawsInTurn(const Robot& robot, const std::vector<std::string>& signals, bool open,
                                          const std::vector<std::string>& causes, std::uint64_t seed, std::size_t turn);

/// The components of the robot on which the cause that a law stands for has an effect; of sensors only those that are recorded.
std::vector<std::string> componentsOf(const OutOfCatalogueLaw& law, const Robot& robot, const std::vector<std::string>& signals);

/// Parameters that are whole numbers: a larger number is a weaker effect, and half as many levels are one bit less.
bool countsBits(const EffectParameter& parameter);

/// Draws parameters within the usual ranges: the first log-uniform, with either sign if the range has both, shape parameters anywhere in
/// their range.
std::vector<double> drawSizes(const EffectInfo& law, RandomStream& random);
/// The effect made `factor` times as strong: all parameters except shapes move away from neutral. Empty if a parameter leaves its allowed
/// range or three times its usual range.
std::optional<std::vector<double>> scaled(const EffectInfo& law, std::vector<double> values, double factor);

/// Draws and scales sizes up to ten times until the change that the cause makes alone lies in the band; empty if it never does. A dead band
/// must also shut the pressure of a muscle off in a twentieth of the fitted rows, and deliver it in another twentieth.
std::optional<Cause> causeOfSize(const OutOfCatalogueLaw& law, const std::string& component, const std::string& size, const Truth& truth,
                                 RandomStream& random);

}  // namespace musclesim::blind
