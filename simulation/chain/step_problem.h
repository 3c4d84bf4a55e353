/// The box-constrained problem of one step. It is solved by eliminating beads, chains and bones, then solving the core.
///
///     M u - J^T l = M v/h + f,   J u + cfm/h l = c/h + w,   lower <= l <= upper, w complementary      u = v+ / h
/// A row at a bound is left out of the linear system; its force acts on its bodies like any other force.
#pragma once

#include <vector>

#include "box_active_set.h"
#include "bundle.h"
#include "contact_set.h"
#include "core_order.h"
#include "model.h"
#include "skeleton_core.h"

namespace musclesim::chain {

class StepProblem final : public BoxProblem {
 public:
  /// The model must outlive the problem.
  explicit StepProblem(Model& model);

  struct Conditions {
    double h_s;
    Vector gravity;  ///< mm/s^2
    double force_per_N;
    ErrorReduction reduction;
    double contact_reduction;  ///< share of a contact's depth corrected in the step
    double contact_softness;   ///< ODE's CFM of a contact's normal
    double world_softness;     ///< ODE's CFM of the world, for a contact's friction
    double friction_force;     ///< largest friction force of a contact
    bool operator==(const Conditions&) const = default;
  };
  /// Sets up the step for the present state of the bodies and the tensions of the actuators. Returns false if a contact touches an unknown
  /// body.
  bool begin(const Conditions& conditions, const std::vector<ContactPoint>& contacts);
  /// The bounded rows. A row that existed in the last step starts with its state at the end of that step.
  std::vector<BoundedRow>& rows() { return rows_; }
  /// Keeps the states for the next step and writes u of all bodies.
  void end(std::vector<Vector6>& u);
  /// Forgets the states of the last step.
  void forget();

  void solve(std::vector<BoundedRow>& rows) override;
  void changed(int row) override;
  double forceTolerance() const override { return 1e-10 * force_scale_; }
  double slackTolerance() const override { return 1e-12 * velocity_scale_; }

 private:
  enum class RowKind : signed char { chain_joint, skeleton_joint, contact };
  struct RowPlace {
    RowKind kind;
    int owner, part;  ///< chain and joint; skeleton joint; contact and direction
  };
  /// A joint's rows and the state of its bounded row.
  struct JointState {
    JointRows rows;
    AxisContact contact_before = AxisContact::none;
    RowState state = RowState::free;
    bool bounded = false;
    double force = 0;  ///< force of the bounded row while it is at a bound
    int core_row = 0;  ///< skeleton: number of the first row in the core
    bool axisFree() const { return rows.row_count == 6 && state == RowState::free; }
  };
  struct ChainState {
    int bundle, lane;
    std::vector<JointState> joints;
    JointState start;
    std::vector<int> border_rows;  ///< core rows of its border: three of the ball joint at the start, then free contact rows
    std::vector<RowPlace> border_contacts;
    bool start_in_band[3];
    Eigen::Matrix3d start_block;  ///< J S J^T + cfm/h of the ball at the start
  };
  struct BoneState {
    Eigen::Matrix3d inertia;         ///< in the frame of the world
    Vector spin_momentum;            ///< I w
    Matrix6 mass = Matrix6::Zero();  ///< including the stiffness of a fixation
    Vector6 momentum;                ///< M v/h + f
    double per_mass, per_inertia;
    bool lone = false;       ///< fixed and without other joints
    bool touched = false;    ///< a contact touches it
    bool rests = false;      ///< its u is the same as in the last step
    bool was_alone = false;  ///< lone and not touched in the last step, which started from motion_before and bone_before
    BodyMotion motion_before;
    Bone bone_before;
  };

  void findLoneBones();
  void reserve();
  void findRestingBones(bool same_conditions);
  void addLoads();
  void makeJointRows();
  void addAxisForce(const JointModel& joint, const JointRows& rows, double force);
  void setUpBundles();
  void setUpStart(std::size_t number);
  void setUpBones();
  void arrangeCore();
  void collectRows();
  void collectRow(JointState& joint, RowPlace place, double diagonal);
  double diagonalOf(const ContactRows& contact, int row) const;

  void takeStates(const std::vector<BoundedRow>& rows);
  void setUpBorders();
  void setUpContactBorder(std::size_t number, int row);
  void eliminateChains();
  void numberRows();
  void chooseBand();
  void findStiffStart(std::size_t number);
  bool isInBand(const ContactRows& contact, int row) const { return keeps_bones_ && contact.soft[row] && touchesChain(contact); }
  bool touchesChain(const ContactRows& contact) const { return ownerOf(contact) >= 0; }
  int ownerOf(const ContactRows& contact) const;
  void numberContacts(int& next);
  void assembleCore();
  void addBones();
  void addChain(std::size_t number);
  void addSkeleton();
  double softnessOfContact(int row) const { return row == 0 ? conditions_.contact_softness : conditions_.world_softness; }
  void addContact(std::size_t number, int row);
  void addSharedBead(const ContactRows& contact, int row, int side);
  double throughBead(int body, const double first[6], const double second[6]) const;
  void substitute();
  void giveForces(std::vector<BoundedRow>& rows);
  double slackOfSkeleton(std::size_t number) const;
  double slackOfContact(const ContactRows& contact, int row) const;
  double alongBody(int body, const double jacobian[6]) const;

  Model& model_;
  Conditions conditions_{};
  ContactSet contacts_;
  std::vector<ChainState> chains_;
  std::vector<JointState> skeleton_, fixed_;
  std::vector<BoneState> bones_;
  std::vector<Bundle> bundles_;
  std::vector<char> bundle_dirty_;
  CoreOrder order_;
  bool keeps_bones_ = false;  ///< moving bones are unknowns of the core
  SkeletonCore core_;
  SkeletonCore::Layout layout_;
  std::vector<BoundedRow> rows_;
  std::vector<RowPlace> places_;
  double force_scale_ = 0, velocity_scale_ = 0;
};

}  // namespace musclesim::chain
