/// The readers of the formats. A reader that this program was built without throws BadParameter.
#pragma once

#include <string>

#include "source_robot.h"

namespace musclesim {

/// `file` names the text in messages; what it includes is looked for beside it.
SourceRobot readUrdf(const std::string& text, const std::string& file);
SourceRobot readMjcf(const std::string& text, const std::string& file);
SourceRobot readSdf(const std::string& file);

}  // namespace musclesim
