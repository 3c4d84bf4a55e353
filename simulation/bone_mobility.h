/// How easily bones that joints hold together give way to forces.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "musclesim/robot/joint.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

/// Accelerations of bones per force, in their present poses and at rest, joints obeyed exactly:
///     P = W - W G^T (G W G^T)^+ G W
/// W = diag(1/m, (R I R^T)^-1) over all bones, G the rows that joints demand of velocities (G v = 0), ^+ the pseudoinverse: joints may
/// demand the same thing twice. Stops and friction are left out, and so are the second rows of joints with two axes: without them bones
/// give way more.
class BoneMobility {
 public:
  /// Of all bodies that `joints` hold, apart from `left_out` (sorted), whose joints are left out too.
  BoneMobility(const std::vector<std::unique_ptr<Joint>>& joints, const std::vector<dBodyID>& left_out);

  /// J_a P J_b^T: how fast line a gets longer under a force of 1 on line b, per time; in 1/g. Bodies without a joint move freely.
  double between(const std::vector<LineOfPull::Push>& a, const std::vector<LineOfPull::Push>& b) const;

 private:
  Eigen::Index placeOf(dBodyID body) const;
  std::vector<dBodyID> bodies_;  ///< in the order of the joints, not of addresses: rounding must not depend on memory
  Eigen::MatrixXd mobility_;     ///< P, 6 unknowns per body: velocity of the centre of mass, angular velocity, world frame
};

}  // namespace musclesim
