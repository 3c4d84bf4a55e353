/// Where a program that is started stands. Programs are started by their full path and without a shell.
#pragma once

#include <filesystem>
#include <string>

namespace musclesim {

/// The program of this name in the first folder of PATH that has it; empty if there is none. Folders of PATH that are no full paths (an
/// empty one, ".") are left out: they would start whatever stands where the user happens to work.
std::filesystem::path programInPath(const std::string& name);

}  // namespace musclesim
