/// The default stepper. It solves the same problem as dWorldStep, but its cost grows with the number of links and not with the cube of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model.h"
#include "musclesim/simulation/stepper.h"
#include "step_problem.h"

namespace musclesim {

class Contacts;
class World;

struct ChainStatistics {
  long steps = 0;
  long unsolved_steps = 0;   ///< steps that dWorldStep had to do
  long rounds = 0;           ///< linear solves
  long monotone_rounds = 0;  ///< linear solves in the active set's second phase
  int largest_rounds = 0;    ///< most linear solves in one step
};

/// Handles robots made of bones and actuators: ball joints, hinges and sliders between bones or to the environment, bones fixed to the
/// environment, chains of equal beads with both ends connected, and contacts. For any other robot dWorldStep does the steps, and message()
/// says why.
class ChainStepper final : public Stepper {
 public:
  /// `strict`: throws for a robot that it cannot handle instead of using dWorldStep.
  ChainStepper(const World& world, const Contacts& contacts, const BodyBounds& bounds, bool strict);
  ~ChainStepper() override;

  void prepare() override;
  void applyForces(const Actuators& actuators, double h_s) override;
  void step(double h_s) override;
  std::string name() const override { return reason_.empty() ? "chain" : "ode"; }
  std::string message() const override;
  long unsolvedSteps() const override { return statistics_.unsolved_steps; }
  bool hasCheckedBounds() const override { return state_is_current_; }
  std::optional<TornJoint> largestGap() const override;

  const ChainStatistics& statistics() const { return statistics_; }

 private:
  bool upToDate() const;
  bool solve(double h_s);
  void leaveToOde(double h_s);

  const World& world_;
  const Contacts& contacts_;
  BodyBounds bounds_;
  bool strict_;
  double registered_reduction_ = 0;  ///< ODE's ERP of the world as the simulation set it
  long revision_ = -1;               ///< revision of the simulation when the model was registered
  std::string reason_;               ///< why dWorldStep is used; empty if it is not used
  chain::Model model_;
  std::unique_ptr<chain::StepProblem> problem_;
  chain::BoxActiveSet active_set_;
  std::vector<chain::Vector6> new_velocity_;  ///< u of all bodies
  bool state_is_current_ = false;             ///< the model's bodies have the poses of ODE's bodies
  ChainStatistics statistics_;
};

}  // namespace musclesim
