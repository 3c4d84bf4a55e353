#include "../../simulation/chain/chain_bundle.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "musclesim/base/random.h"

namespace musclesim::chain {
namespace {

/// A chain of random sliders and hinges in turn, for ChainBundle and as one dense system
///     J u + cfm/h l = c/h,   u = a + S J^T l   where u of the bone and y of the border are given.
struct RandomChain {
  int beads;
  BeadInertia inertia{0.1, 0.02};
  std::vector<JointRows> joints;
  std::vector<Vector6> a;
  double border[3][6];
  double border_force[3];
  Vector6 bone_velocity;
  std::vector<double> given;  ///< force of row 5; NaN: free

  RandomChain(RandomStream& random, int bead_count) : beads(bead_count), joints(static_cast<std::size_t>(bead_count)) {
    for (std::size_t k = 0; k < joints.size(); ++k) {
      JointRows& rows = joints[k];
      rows.row_count = k + 1 < joints.size() ? 6 : 3;
      for (int row = 0; row < rows.row_count; ++row) {
        rows.velocity[row] = random.normal();
        rows.softness[row] = 1e-3;
      }
      fill(random, k % 2 == 0, rows);
      Vector6 motion;
      for (int i = 0; i < 6; ++i) motion[i] = random.normal();
      a.push_back(motion);
      given.push_back(k % 3 == 1 && rows.row_count == 6 ? random.normal() : std::nan(""));
    }
    for (int c = 0; c < 3; ++c) {
      for (double& entry : border[c]) entry = random.normal();
      border_force[c] = random.normal();
    }
    for (int i = 0; i < 6; ++i) bone_velocity[i] = random.normal();
  }

  /// (0 1; d t) and (0 -1; -d t) of a slider, (1 C; 0 e) and (-1 D; 0 -e) of a hinge, (1 C) and (-1 D) of the ball.
  static void fill(RandomStream& random, bool slider, JointRows& rows) {
    for (int row = 0; row < 3; ++row) {
      const int held = slider ? 3 + row : row;
      rows.jacobian[0][row][held] = 1;
      rows.jacobian[1][row][held] = -1;
      for (int i = 3; i < 6 && !slider; ++i)
        for (auto& body : rows.jacobian) body[row][i] = random.normal();
    }
    for (int row = 3; row < rows.row_count; ++row)
      for (int i = slider ? 0 : 3; i < 6; ++i) {
        rows.jacobian[0][row][i] = random.normal();
        rows.jacobian[1][row][i] = (slider && i >= 3 ? 1 : -1) * rows.jacobian[0][row][i];
      }
  }

  template <typename Bundle>
  void put(Bundle& bundle, int lane, double h_s) const {
    bundle.setInertia(lane, inertia);
    for (int k = 0; k < beads; ++k) {
      const auto i = static_cast<std::size_t>(k);
      bundle.setJoint(lane, k, joints[i], h_s);
      bundle.setFreeMotion(lane, k, a[i]);
      if (!std::isnan(given[i])) bundle.setForce(lane, k, given[i]);
    }
    for (int c = 0; c < 3; ++c) bundle.addBorder(lane, c, 0, border[c]);
  }

  /// Velocities of all beads, by the dense system.
  Eigen::VectorXd velocities(double h_s) const {
    const int n = 6 * beads;
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd target = Eigen::VectorXd::Zero(n), motion(n), softness = Eigen::VectorXd::Ones(n);
    const Eigen::VectorXd s =
        (Eigen::VectorXd(6) << Eigen::Vector3d::Constant(inertia.per_mass), Eigen::Vector3d::Constant(inertia.per_inertia))
            .finished()
            .replicate(beads, 1);
    for (int k = 0; k < beads; ++k) {
      motion.segment<6>(6 * k) = a[static_cast<std::size_t>(k)];
      if (k == 0)
        for (int c = 0; c < 3; ++c) motion.head<6>() += border_force[c] * s.head<6>().cwiseProduct(Eigen::Map<const Vector6>(border[c]));
    }
    for (int k = 0; k < beads; ++k) {
      const JointRows& rows = joints[static_cast<std::size_t>(k)];
      for (int row = 0; row < rows.row_count; ++row) {
        const Eigen::Map<const Vector6> first(rows.jacobian[0][row]), second(rows.jacobian[1][row]);
        const double force = given[static_cast<std::size_t>(k)];
        if (row == 5 && !std::isnan(force)) {
          motion.segment<6>(6 * k) += force * s.head<6>().cwiseProduct(first);
          motion.segment<6>(6 * k + 6) += force * s.head<6>().cwiseProduct(second);
          continue;
        }
        j.row(6 * k + row).segment<6>(6 * k) = first.transpose();
        target(6 * k + row) = rows.velocity[row] / h_s;
        softness(6 * k + row) = rows.softness[row] / h_s;
        if (k + 1 < beads)
          j.row(6 * k + row).segment<6>(6 * k + 6) = second.transpose();
        else
          target(6 * k + row) -= second.dot(bone_velocity);
      }
    }
    Eigen::MatrixXd system = j * s.asDiagonal() * j.transpose();
    system.diagonal() += softness;
    const Eigen::VectorXd force = system.ldlt().solve(target - j * motion);
    return motion + s.cwiseProduct(j.transpose() * force);
  }
};

template <int lane_count>
void expectLanesLikeTheDenseSystem(RandomStream& random, const std::array<int, lane_count>& counts) {
  const double h_s = 0.01;
  ChainBundle<lane_count> bundle(counts);
  std::vector<RandomChain> chains;
  for (const int beads : counts)
    if (beads > 0) chains.emplace_back(random, beads);
  for (std::size_t lane = 0; lane < chains.size(); ++lane) chains[lane].put(bundle, static_cast<int>(lane), h_s);
  bundle.makeBlocks();
  bundle.eliminate();
  for (std::size_t lane = 0; lane < chains.size(); ++lane) {
    bundle.setBoneVelocity(static_cast<int>(lane), chains[lane].bone_velocity);
    for (int c = 0; c < 3; ++c) bundle.setBorderForce(static_cast<int>(lane), c, chains[lane].border_force[c]);
  }
  bundle.substitute();
  for (std::size_t lane = 0; lane < chains.size(); ++lane) {
    const Eigen::VectorXd expected = chains[lane].velocities(h_s);
    for (int k = 0; k < chains[lane].beads; ++k)
      EXPECT_LT((bundle.velocity(static_cast<int>(lane), k) - expected.segment<6>(6 * k)).norm(), 1e-7 * expected.norm()) << k;
  }
}

TEST(ChainBundle, LanesMatchTheDenseSystem) {
  RandomStream random(3, "chains");
  for (const std::array<int, 4>& counts : {std::array{4, 4, 4, 4}, {2, 8, 4, 6}, {10, 6, 2, 0}, {6, 4, 0, 0}, {6, 0, 0, 0}})
    expectLanesLikeTheDenseSystem<4>(random, counts);
  for (const std::array<int, 2>& counts : {std::array{6, 6}, {2, 8}, {4, 0}}) expectLanesLikeTheDenseSystem<2>(random, counts);
}

/// A bundle of two lanes does the same operations on a chain as one of four lanes.
TEST(ChainBundle, WidthLeavesTheBits) {
  RandomStream random(4, "chains");
  const RandomChain chain(random, 8);
  ChainBundle<2> two({8, 0});
  ChainBundle<4> four({0, 0, 0, 8});
  const auto solve = [&](auto& bundle, int lane) {
    chain.put(bundle, lane, 0.01);
    bundle.makeBlocks();
    bundle.eliminate();
    bundle.setBoneVelocity(lane, chain.bone_velocity);
    for (int c = 0; c < 3; ++c) bundle.setBorderForce(lane, c, chain.border_force[c]);
    bundle.substitute();
  };
  solve(two, 0);
  solve(four, 3);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(two.velocity(0, k), four.velocity(3, k)) << k;
}

}  // namespace
}  // namespace musclesim::chain
