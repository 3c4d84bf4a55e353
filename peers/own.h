/// musclesim itself in the form of its peers.
#pragma once

#include "engine.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim::peers {

/// Internal steps are those of the options; every call of advance() must ask for the internal steps of whole control steps.
class OwnPeer final : public Peer {
 public:
  /// Builds the robot of this name.
  OwnPeer(SimulationOptions options, const std::string& robot);
  void advance(const Action& pressure_ratio, int step_count) override;
  Vector handM() const override;
  double gapM() const override;
  double coordinate(int joint) const override;
  double energyJ() const override { return simulation_.mechanicalEnergyJ(); }

 private:
  mutable Simulation simulation_;  ///< it gives its robot away only if it may be changed
};

}  // namespace musclesim::peers
