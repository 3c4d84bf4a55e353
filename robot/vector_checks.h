/// Checks of points and directions that users give.
#pragma once

#include <fmt/format.h>

#include <string>

#include "musclesim/base/error.h"
#include "musclesim/robot/state.h"

namespace musclesim {

/// Throws BadParameter, naming `what`, unless all components are finite.
inline void requireFinite(const std::string& what, const Vector& v) {
  if (!v.allFinite()) throw BadParameter(what, fmt::format("({}, {}, {})", v.x(), v.y(), v.z()), "be finite");
}

/// Throws BadParameter, naming `what`, unless `v` is finite and not zero.
inline void requireDirection(const std::string& what, const Vector& v) {
  requireFinite(what, v);
  if (v.norm() == 0) throw BadParameter(what, "(0, 0, 0)", "have a direction");
}

}  // namespace musclesim
