#include "musclesim/robot/robot_file.h"

namespace musclesim {

const std::vector<std::pair<std::string, std::string>>& shippedRobotFiles() {
  static const std::vector<std::pair<std::string, std::string>> files = {};
  return files;
}

}  // namespace musclesim
