/// A fitted hypothesis as far as planning an experiment needs it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plant.h"

namespace musclesim {

/// An explanation as fitted, with what is made of it so far and what its numbers can still take up.
struct Rival {
  std::string label;
  Model model;
  double probability;           ///< need not sum to 1
  std::vector<Model> beside{};  ///< with one coordinate each moved by any step
  Eigen::MatrixXd
      slopes{};  ///< what those steps change in the recordings that it was fitted to, times the weights of the fit: [rows, steps]
};

}  // namespace musclesim
