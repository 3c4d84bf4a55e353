/// A rigid body and the primitives that form it.
#pragma once

#include <ode/ode.h>

#include <vector>

namespace musclesim {

class Primitive;

struct Body {
  dBodyID id = nullptr;
  std::vector<Primitive*> parts;
  bool has_joint = false;
};

}  // namespace musclesim
