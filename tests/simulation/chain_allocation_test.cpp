// Counts calls of operator new in this program.
#include <gtest/gtest.h>

#include "step_comparison.h"
#include "support/count_allocations.h"

namespace musclesim {
namespace {

/// Calls of operator new in ODE's broad phase, which allocates if it uses a hash table.
long allocationsOfBroadPhase(dSpaceID space) {
  const long before = allocation_count;
  dSpaceCollide(space, nullptr, [](void*, dGeomID, dGeomID) {});
  return allocation_count - before;
}

void expectNoAllocation(PhysicsKind physics) {
  const auto simulation = makeSimulation({.physics = physics}, StepperKind::automatic);
  RandomStream random(5, "pressures");
  Action command(10);
  for (int i = 0; i < 1500; ++i) {
    if (i % 100 == 0) {
      for (double& pressure : command) pressure = random.uniform();
      simulation->robot().step(command);
    }
    const long of_broad_phase = allocationsOfBroadPhase(simulation->space());
    const long before = allocation_count;
    simulation->step();
    if (i < 500) continue;
    ASSERT_EQ(allocation_count - before, of_broad_phase) << i;
  }
}

TEST(ChainStepper, DoesNotAllocateAfterWarmUp) {
  expectNoAllocation(PhysicsKind::original);
  expectNoAllocation(PhysicsKind::si);
}

}  // namespace
}  // namespace musclesim
