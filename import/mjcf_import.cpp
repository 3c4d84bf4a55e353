#include "formats.h"
#include "musclesim/base/error.h"

namespace musclesim {

SourceRobot readMjcf(const std::string&, const std::string& file) {
  throw BadFile(file, "not yet");
}

}  // namespace musclesim
