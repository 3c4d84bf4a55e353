/// --plugin: robots, controllers and effects in C++ from a shared library.
#pragma once

#include <string>

namespace musclesim::command_line {

/// Loads a shared library and calls its function
///     extern "C" void musclesim_plugin();
/// which registers what it brings (registerRobot, registerController, registerEffect). It stays loaded until the program ends. It must be
/// compiled with the headers of this version. Throws BadFile if it cannot be loaded or lacks that function.
void loadPlugin(const std::string& file);

}  // namespace musclesim::command_line
