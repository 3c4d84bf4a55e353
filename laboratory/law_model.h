/// A family of force laws with parameters that a fit adjusts.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/robot/force_law.h"

namespace musclesim {

/// The properties of the measured muscle that a family of laws needs.
struct Specimen {
  double rest_length_mm = 0;  ///< s = 1, k = 0
  double shortest_mm = 0;     ///< measured
  double force_scale_N = 0;   ///< largest measured force
};

/// The lengths of Eq. 1: a given length, in mm, is fixed; an empty one is fitted.
struct BraunLengths {
  std::optional<double> minimum_mm, maximum_mm;
};

/// A parameter that the fit adjusts, with its bounds.
struct FitParameter {
  std::string name;
  double lowest, highest;
};

/// A constant of the law, for reports.
struct LawConstant {
  std::string name, unit;
  bool is_factor = false;  ///< its interval is symmetric in the logarithm if the sign is certain
};

/// One family. The fit adjusts its parameters, which are chosen for good convergence; reports give its constants, those of the law's
/// formula.
class LawModel {
 public:
  virtual ~LawModel() = default;
  virtual std::string name() const = 0;
  virtual const std::vector<FitParameter>& parameters() const = 0;
  /// Initial parameters of the fits.
  virtual std::vector<Eigen::VectorXd> starts() const = 0;
  /// The law with these parameters. Throws BadParameter if they make no valid law.
  virtual std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& parameters) const = 0;
  virtual std::vector<LawConstant> constants() const = 0;
  virtual Eigen::VectorXd constantsAt(const Eigen::VectorXd& parameters) const { return parameters; }
  /// True if the constants are values of a table, kept smooth by penalties, and have no meaning of their own.
  virtual bool isTable() const { return false; }
  /// Penalties: further residuals, in N per point of the fit. They determine what the points do not. May be empty.
  virtual Eigen::VectorXd penaltiesN(const Eigen::VectorXd&) const { return {}; }
  /// Keys (below "force_law.") and values for a configuration file.
  virtual std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& parameters) const = 0;
  /// The measured length that corresponds to the maximum length of a robot's muscle, mm.
  virtual double restLengthMm(const Eigen::VectorXd& parameters) const = 0;
};

}  // namespace musclesim
