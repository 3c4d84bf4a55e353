#include "../../simulation/chain/skeleton_core.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "../../simulation/chain/core_order.h"
#include "musclesim/base/random.h"

namespace musclesim::chain {
namespace {

Eigen::MatrixXd randomMatrix(RandomStream& random, int rows, int columns) {
  Eigen::MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) m(i, j) = random.normal();
  return m;
}

/// Sums the products of entries that are not 0, and solves.
void expectSolved(TiledMatrix& matrix, const Eigen::MatrixXd& a, RandomStream& random) {
  const auto n = static_cast<int>(a.rows());
  matrix.reset(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j)
      if (a(i, j) != 0) matrix.add(j, i, a(i, j));
  const Eigen::VectorXd expected = randomMatrix(random, n, 1);
  std::vector<double> x(static_cast<std::size_t>(matrix.paddedSize()), 1e3);
  Eigen::Map<Eigen::VectorXd>(x.data(), n) = a * expected;
  matrix.factorise();
  matrix.solve(x.data());
  EXPECT_LT((Eigen::Map<Eigen::VectorXd>(x.data(), n) - expected).norm(), 1e-9 * expected.norm()) << n;
}

TEST(TiledMatrix, SolvesAllSizes) {
  RandomStream random(1, "tiles");
  TiledMatrix matrix;
  for (int n = 1; n < 30; ++n) {
    const Eigen::MatrixXd root = randomMatrix(random, n, n);
    expectSolved(matrix, root * root.transpose() + Eigen::MatrixXd::Identity(n, n), random);
  }
}

/// Uncoupled positive rows, negative rows that couple to all of them, and positive rows that couple to the negative ones.
TEST(TiledMatrix, LeavesOutWhatIsZero) {
  RandomStream random(3, "tiles");
  TiledMatrix matrix;
  for (const int band : {0, 5, 16, 40, 80}) {
    const int negative = 6, size = band + negative + 5;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
    for (int j = 0; j < size; ++j) {
      for (int i = std::max(j + 1, band); i < (j < band ? band + negative : size); ++i) a(i, j) = a(j, i) = random.normal();
      a(j, j) = j >= band && j < band + negative ? -20.0 : 20.0;
    }
    expectSolved(matrix, a, random);
    const int tiles = (size + 7) / 8, band_tiles = band / 8;
    EXPECT_LE(matrix.tileCount(), tiles * (tiles + 1) / 2 - band_tiles * (band_tiles - 1) / 2);
  }
}

/// Four chains touch a fifth one, which comes last, so that there is no fill-in.
TEST(CoreOrder, TakesChainsWithFewNeighboursFirst) {
  CoreOrder order;
  order.reset(5);
  for (const int chain : {1, 2, 3, 4}) order.connect(0, chain);
  order.arrange();
  for (const int chain : {1, 2, 3}) EXPECT_EQ(order.ownerOf(chain, 0), 0) << chain;
  EXPECT_EQ(order.ownerOf(2, -1), 2);
  EXPECT_EQ(order.ownerOf(-1, -1), -1);
  for (int chain = 0; chain < 5; ++chain) order.addRows(chain, 3);
  order.addRows(0, 4);
  order.number();
  EXPECT_EQ(order.rowCount(), 19);
  std::vector<bool> taken(19);
  for (int chain = 0; chain < 5; ++chain)
    for (int row = 0; row < (chain == 0 ? 7 : 3); ++row) taken[static_cast<std::size_t>(order.takeRow(chain))] = true;
  EXPECT_EQ(std::count(taken.begin(), taken.end(), true), 19);
}

/// The whole system at once: [M, -J^T; J, D] (u, y) = (g, r). Some bones are kept, and some rows come before them.
void expectSolved(const SkeletonCore::Layout& layout, RandomStream& random) {
  SkeletonCore core;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const auto bones = static_cast<int>(layout.kept.size());
    const int rows = layout.row_count, size = 6 * bones + rows;
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    const Eigen::VectorXd right = randomMatrix(random, size, 1);
    core.reset(layout);
    for (int b = 0; b < bones; ++b) {
      const Eigen::MatrixXd root = randomMatrix(random, 6, 6);
      const Matrix6 mass = root * root.transpose() + Matrix6::Identity();
      whole.block(6 * b, 6 * b, 6, 6) = mass;
      core.setBone(b, mass, right.segment<6>(6 * b));
    }
    for (int row = 0; row < rows; ++row) {
      whole(6 * bones + row, 6 * bones + row) = 0.5;
      core.addBlock(row, row, 0.5);
      core.addRight(row, right(6 * bones + row));
      for (const int bone : {row % bones, (row + 1) % bones, -1}) {
        const Vector6 j = randomMatrix(random, 6, 1);
        core.couple(row, 1, bone, j.data());
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

TEST(SkeletonCore, SolvesBonesAndRowsTogether) {
  RandomStream random(2, "core");
  for (int i = 0; i < 3; ++i) {
    SkeletonCore::Layout layout;
    layout.row_count = 7 + 5 * i;
    layout.kept.resize(static_cast<std::size_t>(3 + i));
    expectSolved(layout, random);
  }
}

TEST(SkeletonCore, KeepsTheVelocityOfABoneOnWhichNoRowActs) {
  RandomStream random(5, "core");
  SkeletonCore core;
  const Vector6 momentum = randomMatrix(random, 6, 1), jacobian = randomMatrix(random, 6, 1);
  Vector6 velocity[2];
  for (const bool again : {false, true}) {
    core.reset(2, 1);
    core.setBone(0, 2 * Matrix6::Identity(), momentum);
    again ? core.keepVelocity(1) : core.setBone(1, 4 * Matrix6::Identity(), momentum);
    core.addBlock(0, 0, 1);
    core.couple(0, 1, 0, jacobian.data());
    core.solve();
    velocity[again] = core.velocity(1);
  }
  EXPECT_LT((velocity[0] - momentum / 4).norm(), 1e-12);
  EXPECT_EQ(velocity[1], velocity[0]);
}

TEST(SkeletonCore, KeepsBonesBehindTheBand) {
  RandomStream random(4, "core");
  SkeletonCore::Layout layout;
  layout.row_count = 20;
  layout.band = 9;
  for (const std::vector<char>& kept : {std::vector<char>{1, 0, 1}, {1, 1, 1}, {0, 0, 1}}) {
    layout.kept = kept;
    expectSolved(layout, random);
  }
}

}  // namespace
}  // namespace musclesim::chain
