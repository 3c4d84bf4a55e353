/// The robot file that `musclesim robot new` writes.
#pragma once

#include <string>

namespace musclesim::command_line {

/// A lever between two muscles, with comments that say what to change. Throws BadParameter for a name that a robot cannot have.
std::string robotTemplate(const std::string& name);

}  // namespace musclesim::command_line
