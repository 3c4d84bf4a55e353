/// Block elimination of two or four chains at once, one per lane of a Pack.
///
/// The unknowns of a chain are the forces of its joints. Node k stands for the joint between bead k and bead k + 1 (the last node for the
/// ball joint between the end and the bone B) and has six rows. Once the beads are eliminated, each node couples only to its neighbours:
///     A_k,k-1 l_k-1 + A_k l_k + A_k,k+1 l_k+1 + sum_j B_k,j y_j (+ J u_B at the last node) = r_k
///     A_k = J_k S J_k^T + cfm/h,   A_k,k+1 = J_k S J_k+1^T,   r_k = c/h - J_k a,   a = v/h + S f
/// S is the beads' inverse inertia, u_B the bone's new velocity / h, y_j the forces of the border rows. The core solves the border rows:
/// the ball joint at the start (3 rows) and the free rows of contacts on the beads. Elimination runs from the start to the end of the
/// chain, A_k = L D L^T.
///
/// The joints are a slider, a hinge, a slider, ..., a slider and the ball joint. joint_rows makes their Jacobians J, one per body:
///     slider (0 1; d t) and (0 -1; -d t),   hinge (1 C; 0 e) and (-1 D; 0 -e),   ball (1 C) and (-1 D), or 0 for the environment.
#pragma once

#include <array>
#include <vector>

#include "body_state.h"
#include "joint_rows.h"
#include "pack.h"
#include "simd_kernels.h"

namespace musclesim::chain {

/// Inverse mass and inertia of a chain's beads.
struct BeadInertia {
  double per_mass = 0, per_inertia = 0;
  double operator[](int component) const { return component < 3 ? per_mass : per_inertia; }
};

template <int lane_count>
class ChainBundle {
 public:
  /// Chains of different length are aligned at their ends; the first nodes of a shorter chain are empty. Bead counts are even; 0 leaves a
  /// lane empty.
  explicit ChainBundle(const std::array<int, lane_count>& bead_counts);

  int nodeCount() const { return static_cast<int>(nodes_.size()); }

  /// Sets the rows of joint k of a chain for a step of h. J must have the form above.
  void setJoint(int lane, int joint, const JointRows& rows, double h_s);
  void setInertia(int lane, const BeadInertia& inertia);
  /// Sets a of a bead without the forces of rows at a bound.
  void setFreeMotion(int lane, int bead, const Vector6& a);
  /// Computes the blocks A_k and A_k,k+1. Call it after all joints are set.
  void makeBlocks();

  /// Sets row 5 of a joint free, or to a bound with the given force.
  void setFree(int lane, int joint);
  void setForce(int lane, int joint, double force);
  /// Clears the forces of contact rows at a bound on the beads, and adds one.
  void clearBeadForces();
  void addBeadForce(int lane, int bead, const double jacobian[6], double force);
  /// Allocates memory for `border_count` border rows.
  void reserve(int border_count);
  /// Starts a new set of border rows; each lane numbers its own from 0.
  void clearBorder();
  /// Sets the Jacobian of a border row on one bead.
  void addBorder(int lane, int column, int bead, const double jacobian[6]);

  /// Eliminates the chains for the present states and border.
  void eliminate();
  /// Results of the elimination for the core. The core subtracts borderBlock() (lower part) and borderRight(); it adds boneMass() (6x6),
  /// boneMomentum() (6) and boneCoupling() (6 per border row) to the system of the bone B.
  double borderBlock(int lane, int i, int j) const { return border_block_[blockIndex(i, j)].value[lane]; }
  double borderRight(int lane, int i) const { return border_right_[static_cast<std::size_t>(i)].value[lane]; }
  const Matrix6& boneMass(int lane) const { return bone_mass_[lane]; }
  const Vector6& boneMomentum(int lane) const { return bone_momentum_[lane]; }
  Vector6 boneCoupling(int lane, int i) const;
  /// a of a bead including the forces of all rows at a bound.
  Vector6 motion(int lane, int bead) const;

  /// Inputs of the back substitution: velocity of the bone B and forces of the border rows.
  void setBoneVelocity(int lane, const Vector6& u);
  void setBorderForce(int lane, int column, double force) { border_force_[static_cast<std::size_t>(column)].value[lane] = force; }
  /// Back substitution: computes the forces of all joints, then the beads' new velocities / h.
  void substitute();
  double axisForce(int lane, int joint) const { return axes_[index(lane, joint)].force[lane]; }
  /// Slack w of row 5 at a bound.
  double axisSlack(int lane, int joint) const { return axes_[index(lane, joint)].slack[lane]; }
  double axisDiagonal(int lane, int joint) const { return axes_[index(lane, joint)].diagonal[lane]; }
  Vector6 velocity(int lane, int bead) const;
  /// Velocity of a bead along a row.
  double velocityAlong(int lane, int bead, const double jacobian[6]) const;
  /// Largest absolute linear velocity / h of any bead.
  double largestVelocity() const;

 private:
  using Pack = chain::Pack<lane_count>;
  struct Node {
    Pack present;            ///< 1 where the chain has this joint, 0 where it is shorter
    Pack jacobian[2][6][6];  ///< [body][row][v, w]
    Pack target[6];          ///< c/h
    Pack softness[6];        ///< cfm/h
    Pack own[6][6];          ///< A_k, lower part
    Pack next[6][6];         ///< A_k,k+1
    Pack factor[6][6];       ///< L below the diagonal
    Pack per_pivot[6];       ///< 1 / D
    Pack coupling[6][6];     ///< L^-1 A_k,k+1; last node: L^-1 J of the bone B
    Pack right[6];           ///< L^-1 r_k
    Pack force[6];           ///< l
  };
  /// Row 5 of a node; stored apart from Node because callers read it joint by joint.
  struct Axis {
    Pack free;      ///< 1 where the row is free, 0 where its force is given
    Pack given;     ///< the given force
    Pack force;     ///< l
    Pack slack;     ///< w
    Pack diagonal;  ///< diagonal entry of A_k
  };
  struct Bead {
    Pack free_motion[6];  ///< v/h + S f
    Pack outer_force[6];  ///< forces of contact rows at a bound
    Pack motion[6];       ///< a
    Pack velocity[6];     ///< u
  };
  struct Column {
    Pack value[6];
  };
  struct Single {
    Pack value;
  };
  struct BorderEntry {
    int lane, column, node;
    double jacobian[6];
  };
  struct Carry;

  MUSCLESIM_INLINE static Pack all(double value) { return Pack{} + value; }
  /// Product of 6-vectors (v, w).
  template <typename Other>
  MUSCLESIM_INLINE static Pack dot(const Pack a[6], const Other b[6]) {
    Pack sum = a[0] * b[0];
    for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
    return sum;
  }
  /// dot() that skips v unless `push`: v of one factor is then 0.
  template <bool push>
  MUSCLESIM_INLINE static Pack dotOf(const Pack a[6], const Pack b[6]) {
    if constexpr (push) return dot(a, b);
    Pack sum = a[3] * b[3];
    for (int i = 4; i < 6; ++i) sum += a[i] * b[i];
    return sum;
  }
  /// sum + w_a . w_b
  MUSCLESIM_INLINE static Pack plusTurn(Pack sum, const Pack a[6], const Pack b[6]) {
    for (int i = 3; i < 6; ++i) sum += a[i] * b[i];
    return sum;
  }
  /// y <- L^-1 y with unit lower L.
  MUSCLESIM_INLINE static void forward(const Pack factor[6][6], Pack y[6]) {
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < i; ++j) y[i] -= factor[i][j] * y[j];
  }
  std::size_t index(int lane, int joint) const { return static_cast<std::size_t>(offset_[static_cast<std::size_t>(lane)] + joint); }
  /// First of the joint's three rows that act on v. The slider of each link lies between its two beads.
  static constexpr int firstPushing(int joint) { return joint % 2 == 0 ? 3 : 0; }
  static std::size_t blockIndex(int i, int j) {
    const int high = i > j ? i : j, low = i > j ? j : i;
    return static_cast<std::size_t>(high * (high + 1) / 2 + low);
  }
  Column* borderOf(int node) { return border_.data() + static_cast<std::size_t>(node) * border_capacity_; }
  const Column* borderOf(int node) const { return border_.data() + static_cast<std::size_t>(node) * border_capacity_; }
  // These are separate functions because other files cannot call a function that is compiled several times.
  MUSCLESIM_SIMD void makeAllBlocks();
  MUSCLESIM_SIMD void eliminateNodes();
  MUSCLESIM_SIMD void substituteAll();
  void growBorder(int count);
  void fillBorder();
  MUSCLESIM_INLINE void moveBeads();
  MUSCLESIM_INLINE void makeSliderBlocks(std::size_t k);
  MUSCLESIM_INLINE void makeHingeBlocks(std::size_t k);
  MUSCLESIM_INLINE void makeBallBlocks(std::size_t k);
  template <bool push>
  MUSCLESIM_INLINE void makeThreeRights(std::size_t k, int first, const Carry& carry);
  MUSCLESIM_INLINE void factorise(Node& node, Pack own[6][6]) const;
  MUSCLESIM_INLINE void factoriseNode(int k, const Carry& carry);
  MUSCLESIM_INLINE void reduceColumns(int k, const Carry& carry);
  MUSCLESIM_INLINE void carryOver(int k, Carry& carry);
  MUSCLESIM_INLINE void accumulateBorder(int k);
  MUSCLESIM_INLINE void leaveToBone();
  MUSCLESIM_INLINE void substituteForces();
  MUSCLESIM_INLINE void substituteVelocities();
  MUSCLESIM_INLINE void makeSlacks();
  MUSCLESIM_INLINE Pack inertia(int component) const { return component < 3 ? per_mass_ : per_inertia_; }
  /// True if the border row acts on node k or a node before it.
  bool reaches(int column, int k) const { return first_node_[static_cast<std::size_t>(column)] <= k; }

  std::array<int, lane_count> bead_count_;
  std::array<int, lane_count> offset_;  ///< number of empty nodes before the chain
  int border_count_ = 0;
  std::size_t border_capacity_ = 0;
  Pack per_mass_{}, per_inertia_{};
  std::vector<Node> nodes_;
  std::vector<Axis> axes_;
  std::vector<Bead> beads_;
  std::vector<Column> border_;
  std::vector<BorderEntry> entries_;
  std::vector<int> first_node_, last_node_;  ///< per border row: first and last node it couples to before the elimination
  std::vector<Single> border_block_, border_right_, border_force_;
  std::vector<Column> bone_coupling_;
  Matrix6 bone_mass_[lane_count];
  Vector6 bone_momentum_[lane_count];
  Pack bone_velocity_[6] = {};
};

extern template class ChainBundle<2>;
extern template class ChainBundle<4>;

}  // namespace musclesim::chain
