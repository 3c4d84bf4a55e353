#include "import.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "formats.h"
#include "muscle_path.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "robot_writer.h"
#include "source_robot.h"

namespace musclesim {

namespace {

/// Skips declarations and comments; the name of the first element of an XML text, empty if there is none.
std::string_view outermostElement(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at)) {
    if (text.substr(at, 4) == "<!--") {
      at = text.find("-->", at);
    } else if (text.substr(at, 2) == "<?" || text.substr(at, 2) == "<!") {
      at = text.find('>', at);
    } else {
      const std::size_t begin = at + 1;
      return text.substr(begin, text.find_first_of(" \t\r\n/>", begin) - begin);
    }
  }
  return {};
}

SourceRobot readSource(const std::string& file) {
  constexpr std::size_t limit_bytes = 8 << 20;
  const std::string text = readTextFile(file, limit_bytes);
  const std::string_view element = outermostElement(text);
  if (element == "robot") return readUrdf(text, file);
  if (element == "mujoco") return readMjcf(text, file);
  if (element == "sdf") return readSdf(file);
  throw BadFile(file, fmt::format("the outermost element is {}; must be robot (URDF), sdf (SDF) or mujoco (MJCF)", inQuotes(element)));
}

}  // namespace

ImportedRobot importRobot(const std::string& file) {
  SourceRobot robot = readSource(file);
  if (robot.name.empty()) robot.name = std::filesystem::path(file).stem().string();
  prepare(robot);
  preparePaths(robot);
  return {robotToml(robot), robot.notes};
}

}  // namespace musclesim
