/// An explanation as the planner of experiments needs it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "../model/plant.h"

namespace musclesim {

/// The model of an explanation, its probability, and the models with one of its coordinates moved.
struct Rival {
  std::string label;
  Model model;
  double probability;           ///< of all rivals; need not sum to 1
  std::vector<Model> beside{};  ///< the models with one coordinate each moved by a step
  Eigen::MatrixXd
      slopes{};  ///< what those steps change in the recordings that it was fitted to, times the weights of the fit: [rows, steps]
};

}  // namespace musclesim
