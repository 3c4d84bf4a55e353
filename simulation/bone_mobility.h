/// Mobility of jointed bones: how they accelerate under forces.
#pragma once

#include <ode/ode.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "musclesim/robot/joint.h"
#include "musclesim/robot/line_of_pull.h"

namespace musclesim {

/// Accelerations of bones per force, for the present poses, at rest and with exact joints:
///     P = W - W G^T (G W G^T)^+ G W
/// W = diag(1/m, (R I R^T)^-1) over all bones; G holds the joints' constraint rows (G v = 0); ^+ is the pseudoinverse, because joints may
/// be redundant. Stops and friction are left out, and so is the row that keeps the angle between the axes of a two-axis joint; without them
/// the mobility is larger.
class BoneMobility {
 public:
  /// Covers all bodies of `joints` except those in `left_out` (sorted); joints on a body in `left_out` are ignored.
  BoneMobility(const std::vector<std::unique_ptr<Joint>>& joints, const std::vector<dBodyID>& left_out);

  /// J_a P J_b^T in 1/g: second derivative of line a's length under a unit force of line b. Bodies without a joint move freely.
  double between(const std::vector<LineOfPull::Push>& a, const std::vector<LineOfPull::Push>& b) const;

 private:
  Eigen::Index placeOf(dBodyID body) const;
  std::vector<dBodyID> bodies_;  ///< in the order of the joints, not of addresses, so that rounding does not depend on memory
  Eigen::MatrixXd mobility_;     ///< P, 6 unknowns per body: velocity of the centre of mass, angular velocity, world frame
};

}  // namespace musclesim
