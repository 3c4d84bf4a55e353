/// What is thrown when there is nothing to draw with.
#pragma once

#include "musclesim/base/error.h"

namespace musclesim {

/// No display, no OpenGL, or one that is too old. The message names the way out.
class SceneError : public BadParameter {
  using BadParameter::BadParameter;
};

}  // namespace musclesim
