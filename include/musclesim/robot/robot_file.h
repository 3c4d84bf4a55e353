/// Robots that a text file describes: docs/reference/robot_format.md.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/robot/robot.h"

namespace musclesim {

/// Whether a robot's name is the name of a file: it ends in ".toml".
bool isRobotFile(const std::string& robot);

/// Builds the robot that a file describes. A file is read once, and again when its time or size has changed.
/// Throws IoError if it cannot be read, BadFile with the line of what is wrong.
std::unique_ptr<Robot> makeRobotFromFile(const std::string& file, World& world);

/// The name that a file gives to its robot, the group of its parameters. Throws as makeRobotFromFile.
std::string nameOfRobotFile(const std::string& file);

/// The same from text. `file` is used in messages and gives the robot its name, unless the text has one.
std::unique_ptr<Robot> makeRobotFromText(const std::string& text, const std::string& file, World& world);

/// Checks what does not depend on numbers: syntax, keys, types, names and references. Throws BadFile.
void checkRobotText(const std::string& text, const std::string& file);

/// Constants of muscles' own force laws that a file does not state, with the defaults that hold for them: one sentence for each set of
/// muscles with the same ones. Defaults of 0 are left out. Throws as makeRobotFromFile.
std::vector<std::string> unstatedConstants(const std::string& file);

/// A robot that comes with the program: the files in robots/.
struct ShippedRobot {
  std::string name, text, description;
};
const std::vector<ShippedRobot>& shippedRobots();

/// Throws BadParameter if none has that name.
std::unique_ptr<Robot> makeShippedRobot(const std::string& name, World& world);

}  // namespace musclesim
