/// The causes of one plant, and how much each of them alone explains.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cause.h"
#include "numbers.h"
#include "plan.h"
#include "truth.h"

namespace musclesim::blind {

/// A cause and what only it explains, as contributionBeside() says.
struct PlantCause {
  Cause cause;
  std::map<std::string, double> contribution = {};  ///< by signal, RMSE over noise
  double contribution_over_noise = 0;               ///< the largest of them
  bool demanded = true;                             ///< whether an answer must have it
};

/// A plant with everything that is hidden from the diagnosis.
struct Plant {
  Plan plan;
  NumberErrors numbers;
  Truth truth;
  double gap_of_step_over_noise = 0;      ///< what the plant's finer step changes alone
  Truth::Motion motion = {};              ///< with all causes, without noise
  bool machine = false;                   ///< causes and sizes of a real machine
  std::vector<PlantCause> causes = {};    ///< an unknown one last
  std::vector<std::string> redrawn = {};  ///< causes that did not reach their size or were too weak, "law@component"
};

/// Whether an answer must have a cause: in some signal it contributes at least three noise floors, because less can hide in another cause's
/// error, and a tenth of the plant's gap in that signal. One floor is enough for a lone cause. Both by signal, RMSE over noise.
bool isDemanded(const std::map<std::string, double>& contribution, const std::map<std::string, double>& gap, std::size_t cause_count);

/// The laws of all causes.
std::vector<ActiveEffect> lawsOf(const std::vector<PlantCause>& causes);

/// What `blind make` asks for.
struct PlantRequest {
  std::string name, robot;          ///< robot: a name or a robot file
  std::size_t turn = 0;             ///< among the plants of this robot
  std::vector<std::string> kinds;   ///< as in drawKind
  std::vector<std::string> causes;  ///< ids of the catalogue; empty: all
  bool exact_numbers = false;       ///< no errors of the model's numbers
  double duration_s = 6;
  std::uint64_t seed = 1;
  std::function<bool()> interrupted;
};

/// Draws a plant. Half of those with several causes are packages of real machines (machine.h), unless the request names causes. A cause
/// that contributes less than one noise floor is drawn again, three times at most: with other sizes on a machine, otherwise by another law.
/// Empty if interrupted. Throws BadParameter where no drawn cause reaches its size, or the model never agrees with itself at half its step.
std::optional<Plant> drawPlant(const PlantRequest& request);

}  // namespace musclesim::blind
