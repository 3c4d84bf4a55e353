/// Force laws as families of functions that a fit chooses from.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// The measured muscle as far as a family of laws needs to know it.
struct Specimen {
  double rest_length_mm = 0;  ///< s = 1, k = 0
  double shortest_mm = 0;     ///< measured
  double force_scale_N = 0;   ///< largest measured force
};

/// What Eq. 1 takes for its lengths: a number in mm is held, empty is fitted.
struct BraunLengths {
  std::optional<double> minimum_mm, maximum_mm;
};

/// A number that the fit may choose.
struct FitParameter {
  std::string name;
  double lowest, highest;
};

/// A constant of the law as it is reported.
struct LawConstant {
  std::string name, unit;
  bool is_factor = false;  ///< its interval is symmetric in the logarithm where its sign is sure
};

/// One family. Parameters are what the fit moves, chosen so that it moves well; constants are what the law's formula calls them.
class LawModel {
 public:
  virtual ~LawModel() = default;
  virtual std::string name() const = 0;
  virtual const std::vector<FitParameter>& parameters() const = 0;
  /// Where fits start.
  virtual std::vector<Eigen::VectorXd> starts() const = 0;
  /// The law with these parameters. Throws BadParameter where there is none.
  virtual std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& parameters) const = 0;
  virtual std::vector<LawConstant> constants() const = 0;
  virtual Eigen::VectorXd constantsAt(const Eigen::VectorXd& parameters) const { return parameters; }
  /// Whether the constants are values of a table, which penalties keep smooth, and not numbers with a meaning of their own.
  virtual bool isTable() const { return false; }
  /// Further residuals in N, per point of the fit, that it makes small: they decide what the points leave open. May be empty.
  virtual Eigen::VectorXd penaltiesN(const Eigen::VectorXd&) const { return {}; }
  /// Keys below "force_law." and values, for a configuration file.
  virtual std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& parameters) const = 0;
  /// The measured length that corresponds to the maximum length of a robot's muscle, mm.
  virtual double restLengthMm(const Eigen::VectorXd& parameters) const = 0;
};

}  // namespace musclesim
