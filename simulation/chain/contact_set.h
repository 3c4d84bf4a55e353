/// Contacts of one step as constraint rows between two bodies: one row along the normal, then two rows of friction.
///
/// As in ODE's surface mode 0 contacts do not bounce, and friction is bounded by a constant force, not by a share of the normal force.
///     normal  n . (velocity of the first - of the second at the point) = erp/h * depth,   0 <= l
///     friction t . (the same velocity) = 0 for t = t1, t2,                                -mu <= l <= mu
#pragma once

#include <cstdint>
#include <vector>

#include "../contacts.h"
#include "body_state.h"
#include "box_active_set.h"

namespace musclesim::chain {

struct ContactRows {
  int body[2];               ///< the first is never the environment
  int row_count;             ///< 1 without friction, else 3
  double jacobian[2][3][6];  ///< [body][row][v, w]
  double velocity[3];        ///< c
  double lower[3], upper[3];
  RowState state[3];  ///< state at the end of the step; the same contact starts the next step with it
  int core_row[3];    ///< row number in the core, -1 where the force is given
  bool soft[3];       ///< the row's softness is a large part of its diagonal entry of A
  int before[2];      ///< per body: the previous contact that acts on the same body, -1 if there is none
};

class ContactSet {
 public:
  /// Makes the rows of this step's contacts. Each contact starts with the states that the contact between the same bodies had in the last
  /// step. Returns false if a contact touches a body that is not in `bodies`.
  bool make(const std::vector<ContactPoint>& points, const BodyState& bodies, double friction_force, double reduction_per_s);
  void clear() { contacts_.clear(); }
  void reserve(std::size_t count) {
    contacts_.reserve(count);
    before_.reserve(count);
  }
  std::vector<ContactRows>& all() { return contacts_; }
  const std::vector<ContactRows>& all() const { return contacts_; }

 private:
  void warmStart(ContactRows& contact, const BodyState& bodies) const;
  void linkBodies(int body_count);

  std::vector<ContactRows> contacts_, before_;
  std::vector<int> last_;  ///< per body: the last contact that acts on it
};

}  // namespace musclesim::chain
