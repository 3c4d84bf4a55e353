/// What the pointer holds.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "simulation/snapshot.h"

namespace musclesim {

struct Grab {
  int primitive = -1;        ///< number in World::primitives(); -1: the target
  Eigen::Vector3f point_mm;  ///< in the primitive's own frame; of the target: where it is
  Eigen::Vector3f seen_mm;   ///< where it was held, world frame
};

/// What a ray from `eye_mm` through `through_mm` meets first: a bone, or the target's sphere. None if it meets neither.
std::optional<Grab> grabAt(const Snapshot& snapshot, const Eigen::Vector3f& eye_mm, const Eigen::Vector3f& through_mm);

}  // namespace musclesim
