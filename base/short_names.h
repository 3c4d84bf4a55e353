/// Names of files for readers.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// The files' names without folders, in the same order. Where two would be the same, with the innermost folder: run_1/run.csv.
std::vector<std::string> shortNames(const std::vector<std::string>& files);

}  // namespace musclesim
