#include "contacts.h"

namespace musclesim {

Contacts::Contacts(dWorldID world, dSpaceID space, double friction_limit)
    : world_(world), near_(space), friction_limit_(friction_limit), joints_(dJointGroupCreate(0)) {
  surface_.mu = friction_limit_;
}

Contacts::~Contacts() {
  dJointGroupDestroy(joints_);
}

void Contacts::soften(double error_reduction, double softness) {
  surface_.mode = dContactSoftERP | dContactSoftCFM;
  surface_.soft_erp = error_reduction;
  surface_.soft_cfm = softness;
}

void Contacts::collide(long revision) {
  dJointGroupEmpty(joints_);
  points_.clear();
  near_.collide(revision, this, &Contacts::onNear);
}

void Contacts::onNear(void* contacts, dGeomID first, dGeomID second) {
  // The beads of a muscle share one space, and geoms of the same space are not tested against each other.
  if (dGeomIsSpace(first) || dGeomIsSpace(second)) return dSpaceCollide2(first, second, contacts, &Contacts::onNear);
  static_cast<Contacts*>(contacts)->add(first, second);
}

void Contacts::add(dGeomID first, dGeomID second) {
  const dBodyID first_body = dGeomGetBody(first), second_body = dGeomGetBody(second);
  if (first_body == second_body) return;
  // Contact joints made earlier in this step count too, so a pair of bodies gets only one contact.
  if (first_body && second_body && dAreConnected(first_body, second_body)) return;
  dContact contact = {};
  contact.surface = surface_;
  if (dCollide(first, second, 1, &contact.geom, sizeof(dContact)) == 0) return;
  const dJointID joint = dJointCreateContact(world_, joints_, &contact);
  dJointAttach(joint, first_body, second_body);
  points_.push_back({{first_body, second_body}, contact.geom});
}

}  // namespace musclesim
