/// `musclesim blind calibrate`: fits the weights of the evidence to stored answers whose keys are open.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace musclesim::blind {

/// All explanations that the diagnosis of one case fitted, and which of them are right.
struct TriedCase {
  std::string name;
  Eigen::MatrixXd features;      ///< per explanation: misfit beyond each tolerance, then complexity (diagnosis.json: fitted.trials)
  Eigen::VectorXd numbers_cost;  ///< nats for numbers of the model that are off
  std::vector<bool> is_right;    ///< holds every demanded cause and nothing wrong
  bool isUsable() const;         ///< some, but not all, are right
};

struct Calibration {
  Eigen::VectorXd before, after;          ///< weights in nats: of the misfits, then of the complexity
  double mean_ln_before = 0;              ///< mean over cases of ln(probability of the right explanations)
  double mean_ln_after = 0;               ///< the same, each fifth of the cases with weights fitted to the others
  int first_before = 0, first_after = 0;  ///< cases whose likeliest explanation is right
  std::vector<std::string> used;
  std::vector<std::string> unused;  ///< cases in which no explanation that was tried is right, or that have an unknown cause
};

/// The names of the weights.
std::vector<std::string> weightNames();

/// The tried explanations of all answers FOLDER/NAME.json to a file of keys. Throws BadFile for files of another form.
std::vector<TriedCase> triedCases(const std::filesystem::path& keys, const std::filesystem::path& answers);

/// Conditional logit (McFadden 1974): maximises the sum of ln(sum over right explanations of exp(score) / sum over all of exp(score)),
/// score = -weights . features - numbers_cost, less a ridge that holds ln(weights) to those in force.
Calibration calibrate(const std::vector<TriedCase>& cases);

}  // namespace musclesim::blind
