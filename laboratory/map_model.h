/// The family of measured maps: forces at nodes, kept smooth where points are few.
#pragma once

#include "law_model.h"
#include "musclesim/robot/force_map.h"

namespace musclesim {

/// It has nodes at 4 pressures and at 4 to 16 lengths, about 5 % of the rest length apart. A penalty on the second differences of the
/// forces at nodes keeps it smooth: weak over length, where measured maps bend, and strong over pressure, where they are nearly straight.
class MapModel final : public LawModel {
 public:
  explicit MapModel(const Specimen& specimen);
  std::string name() const override { return "map"; }
  const std::vector<FitParameter>& parameters() const override { return parameters_; }
  std::vector<Eigen::VectorXd> starts() const override;
  std::unique_ptr<ForceLaw> build(const Eigen::VectorXd& parameters) const override;
  std::vector<LawConstant> constants() const override;
  bool isTable() const override { return true; }
  Eigen::VectorXd penaltiesN(const Eigen::VectorXd& parameters) const override;
  std::vector<std::pair<std::string, std::string>> configuration(const Eigen::VectorXd& parameters) const override;
  double restLengthMm(const Eigen::VectorXd&) const override { return specimen_.rest_length_mm; }

 private:
  static constexpr int pressure_count_ = 4;
  ForceMapTable tableOf(const Eigen::VectorXd& parameters) const;

  Specimen specimen_;
  int length_count_;
  std::vector<FitParameter> parameters_;
};

}  // namespace musclesim
