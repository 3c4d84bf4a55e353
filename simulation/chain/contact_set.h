/// Contacts of one step as rows between two bodies: normal, then two directions of friction.
///
/// ODE's surface mode 0: no bounce; the friction's bound is a constant force, not a share of the normal force.
///     normal  n . (velocity of the first - of the second at the point) = erp/h * depth,   0 <= l
///     friction t1, t2 the same = 0,                                                     -mu <= l <= mu
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
  RowState state[3];  ///< at the end of the step: where the same contact starts in the next
  int core_row[3];    ///< number in the core, -1 where the force is given
  bool soft[3];       ///< its softness is a good part of the diagonal of A
  int before[2];      ///< [body] the last contact before this one that acts on the same body, -1 if there is none
};

class ContactSet {
 public:
  /// Makes the rows of this step's contacts. States are those of the last step's contact between the same bodies.
  /// Returns false if a contact touches a body that is not among the bodies.
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
  std::vector<int> last_;  ///< of every body: the last contact that acts on it
};

}  // namespace musclesim::chain
