/// The broad phase finds the same touching pairs as dSpaceCollide, in the same order.
#include "../../simulation/broad_phase.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "musclesim/base/random.h"
#include "musclesim/simulation/simulation.h"

namespace musclesim {
namespace {

using Pairs = std::vector<std::pair<dGeomID, dGeomID>>;

void collect(void* pairs, dGeomID first, dGeomID second) {
  const dBodyID a = dGeomGetBody(first), b = dGeomGetBody(second);
  if (a == b || (a && b && dAreConnected(a, b))) return;
  dContactGeom contact;
  if (dCollide(first, second, 1, &contact, sizeof contact) > 0) static_cast<Pairs*>(pairs)->emplace_back(first, second);
}

class NearPairsTest : public testing::Test {
 protected:
  NearPairsTest() {
    for (int i = 0; i < 12; ++i) {
      const dBodyID body = bodies.emplace_back(dBodyCreate(world));
      dGeomSetBody(i % 3 == 0   ? dCreateBox(space, 30, 200, 50)
                   : i % 3 == 1 ? dCreateCapsule(space, 20, 150)
                                : dCreateSphere(space, 50),
                   body);
      dBodySetPosition(body, random.uniform(-300, 300), random.uniform(-300, 300), random.uniform(-300, 300));
    }
    dGeomSetPosition(dCreateBox(space, 100, 100, 100), 50, 0, 0);
    dCreatePlane(space, 0, 1, 0, -250);
    const dJointID joint = dJointCreateBall(world, nullptr);
    dJointAttach(joint, bodies[0], bodies[1]);
  }
  ~NearPairsTest() override {
    dSpaceDestroy(space);
    dWorldDestroy(world);
  }

  /// Moves and rotates every body by up to these amounts.
  void stir(double shift_mm, double turn_rad) {
    for (const dBodyID body : bodies) {
      const dReal* x = dBodyGetPosition(body);
      const double moved[3] = {x[0] + random.uniform(-shift_mm, shift_mm), x[1] + random.uniform(-shift_mm, shift_mm),
                               x[2] + random.uniform(-shift_mm, shift_mm)};
      dBodySetPosition(body, moved[0], moved[1], moved[2]);
      dQuaternion turn, turned;
      dQFromAxisAndAngle(turn, random.uniform(-1, 1), random.uniform(-1, 1), 1, random.uniform(-turn_rad, turn_rad));
      dQMultiply0(turned, turn, dBodyGetQuaternion(body));
      dBodySetQuaternion(body, turned);
    }
  }

  Simulation ode_is_running;
  dWorldID world = dWorldCreate();
  dSpaceID space = dSimpleSpaceCreate(nullptr);
  RandomStream random{7, "broad_phase"};
  std::vector<dBodyID> bodies;
  BroadPhase near{space};
};

TEST_F(NearPairsTest, AreThoseOfAllPairsInTheSameOrder) {
  std::size_t found = 0;
  for (int step = 0; step < 2000; ++step) {
    stir(step % 100 == 99 ? 200 : 1.5, 0.02);
    Pairs all, listed;
    dSpaceCollide(space, &all, &collect);
    near.collide(0, &listed, &collect);
    ASSERT_EQ(listed, all) << "step " << step;
    found += all.size();
  }
  EXPECT_GT(found, 500u);
}

TEST_F(NearPairsTest, TakeGeomsThatAreAddedLater) {
  Pairs before, after;
  near.collide(0, &before, &collect);
  dGeomSetPosition(dCreateBox(space, 1000, 1000, 1000), 0, 0, 0);
  near.collide(0, &after, &collect);
  EXPECT_GE(after.size(), before.size() + 6);
}

TEST_F(NearPairsTest, ForgetBodiesThatWerePutTogether) {
  Pairs before, all, listed;
  near.collide(0, &before, &collect);
  dGeomSetBody(dBodyGetFirstGeom(bodies[5]), bodies[4]);
  dBodyDestroy(bodies[5]);
  bodies.erase(bodies.begin() + 5);
  stir(100, 0.5);
  dSpaceCollide(space, &all, &collect);
  near.collide(1, &listed, &collect);
  EXPECT_EQ(listed, all);
}

TEST(BroadPhase, LeaveSpacesOfOtherKindsToOde) {
  const Simulation ode_is_running;
  const dWorldID world = dWorldCreate();
  const dSpaceID space = dHashSpaceCreate(nullptr);
  RandomStream random{8, "broad_phase"};
  for (int i = 0; i < 40; ++i) {
    const dBodyID body = dBodyCreate(world);
    dGeomSetBody(dCreateBox(space, 30, 200, 50), body);
    dBodySetPosition(body, random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200));
  }
  BroadPhase near{space};
  Pairs all, listed;
  dSpaceCollide(space, &all, &collect);
  near.collide(0, &listed, &collect);
  EXPECT_EQ(listed, all);
  EXPECT_GT(all.size(), 10u);
  dSpaceDestroy(space);
  dWorldDestroy(world);
}

}  // namespace
}  // namespace musclesim
