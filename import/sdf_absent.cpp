/// Stands in for the reader of SDF in a program that is built without libsdformat.
#include "formats.h"
#include "musclesim/base/error.h"

namespace musclesim {

SourceRobot readSdf(const std::string& file) {
  throw BadParameter(file + ": this program was built without SDF import (libsdformat-dev)");
}

}  // namespace musclesim
