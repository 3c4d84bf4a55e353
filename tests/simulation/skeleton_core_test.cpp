#include "../../simulation/chain/skeleton_core.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "musclesim/random.h"

namespace musclesim::chain {
namespace {

Eigen::MatrixXd randomMatrix(RandomStream& random, int rows, int columns) {
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = random.normal();
  return m;
}

TEST(DenseCholesky, SolvesAllSizes) {
  RandomStream random(1, "cholesky");
  DenseCholesky cholesky;
  for (int n = 1; n < 30; ++n) {
    const Eigen::MatrixXd root = randomMatrix(random, n, n);
    const Eigen::MatrixXd a = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd expected = randomMatrix(random, n, 1);
    cholesky.reset(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) cholesky.add(j, i, a(i, j));
    Eigen::VectorXd x = a * expected;
    cholesky.factorise();
    cholesky.solve(x.data());
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << n;
  }
}

/// The whole system at once: [M, -J^T; J, D] (u, y) = (g, r).
TEST(SkeletonCore, SolvesBonesAndRowsTogether) {
  RandomStream random(2, "core");
  SkeletonCore core;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const int bones = 3 + repeat, rows = 7 + 5 * repeat, size = 6 * bones + rows;
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    const Eigen::VectorXd right = randomMatrix(random, size, 1);
    core.reset(bones, rows);
    for (int b = 0; b < bones; ++b) {
      const Eigen::MatrixXd root = randomMatrix(random, 6, 6);
      const Matrix6 mass = root * root.transpose() + Matrix6::Identity();
      whole.block(6 * b, 6 * b, 6, 6) = mass;
      core.addBone(b, mass, right.segment<6>(6 * b));
    }
    for (int row = 0; row < rows; ++row) {
      whole(6 * bones + row, 6 * bones + row) = 0.5;
      core.addBlock(row, row, 0.5);
      core.addRight(row, right(6 * bones + row));
      for (const int bone : {row % bones, (row + 1) % bones, -1}) {
        const Vector6 j = randomMatrix(random, 6, 1);
        core.couple(row, bone, j.data());
        if (bone < 0) continue;
        whole.block<1, 6>(6 * bones + row, 6 * bone) += j.transpose();
        whole.block<6, 1>(6 * bone, 6 * bones + row) -= j;
      }
    }
    core.solve();
    const Eigen::VectorXd expected = whole.partialPivLu().solve(right);
    for (int b = 0; b < bones; ++b) EXPECT_LT((core.velocity(b) - expected.segment<6>(6 * b)).norm(), 1e-10);
    for (int row = 0; row < rows; ++row) EXPECT_NEAR(core.force(row), expected(6 * bones + row), 1e-10);
  }
}

}  // namespace
}  // namespace musclesim::chain
