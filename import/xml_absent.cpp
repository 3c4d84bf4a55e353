/// Stands in for the readers of URDF and MJCF in a program that is built without tinyxml2.
#include "formats.h"
#include "musclesim/base/error.h"

namespace musclesim {

SourceRobot readUrdf(const std::string&, const std::string& file) {
  throw BadParameter(file + ": this program was built without URDF import (libtinyxml2-dev)");
}

SourceRobot readMjcf(const std::string&, const std::string& file) {
  throw BadParameter(file + ": this program was built without MJCF import (libtinyxml2-dev)");
}

}  // namespace musclesim
