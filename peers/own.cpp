#include "own.h"

#include "musclesim/base/units.h"

namespace musclesim::peers {

OwnPeer::OwnPeer(SimulationOptions options, const std::string& robot) : simulation_(std::move(options)) {
  simulation_.build(robot);
}

void OwnPeer::advance(const Action& pressure_ratio, int step_count) {
  for (int done = 0; done < step_count; done += simulation_.substeps()) {
    simulation_.robot().step(pressure_ratio);
    simulation_.step();
  }
}

Vector OwnPeer::handM() const {
  return simulation_.robot().handMm() / mm_per_m;
}

double OwnPeer::gapM() const {
  return simulation_.largestGap().gap_mm / mm_per_m;
}

double OwnPeer::coordinate(int joint) const {
  const Joint& of = *simulation_.world().joints()[static_cast<std::size_t>(joint)];
  if (of.kind() == Joint::Kind::slider) return dJointGetSliderPosition(of.id()) / mm_per_m;
  return of.kind() == Joint::Kind::ball || of.kind() == Joint::Kind::fixed ? 0 : of.angleDeg() * rad_per_deg;
}

}  // namespace musclesim::peers
