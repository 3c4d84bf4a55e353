/// The exception for missing means to draw.
#pragma once

#include "musclesim/base/error.h"

namespace musclesim {

/// There is no display, no OpenGL, or the OpenGL is too old. The message says what the user can do.
class SceneError : public BadParameter {
  using BadParameter::BadParameter;
};

}  // namespace musclesim
