/// How far another engine's hand is from musclesim's.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "musclesim/base/random.h"
#include "musclesim/base/units.h"
#include "peers/engine.h"
#include "peers_fixture.h"

namespace musclesim::peers {

inline constexpr double control_step_s = 0.01;

/// The largest distance of the two hands within `duration_s` under one set of random pressures, mm. The joints of `theirs` may open by 1
/// mm.
inline double handDifferenceMm(Sample& ours, Peer& theirs, double duration_s, int substeps_of_theirs) {
  RandomStream random(3, "test");
  Action command(ours.mechanism.muscles.size());
  for (double& pressure : command) pressure = random.uniform();
  double worst_mm = 0;
  for (int i = 0; i < std::lround(duration_s / control_step_s); ++i) {
    ours.simulation.robot().step(command);
    ours.simulation.step();
    theirs.advance(command, substeps_of_theirs);
    worst_mm = std::max(worst_mm, (theirs.handM() * mm_per_m - ours.simulation.robot().handMm()).norm());
  }
  EXPECT_LT(theirs.gapM(), 1e-3);
  return worst_mm;
}

}  // namespace musclesim::peers
