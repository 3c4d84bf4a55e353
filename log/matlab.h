/// MATLAB files, version 5 to 7.3, through libmatio. The program may be built without it: then reading one is an error that says so.
#pragma once

#include <string>
#include <vector>

namespace musclesim {

/// A file that ends in .mat.
bool isMatlabFile(const std::string& file);

/// The arrays of one length as the text of a table with commas and a header. A vector becomes the column of its name, `position`; a matrix
/// one column for each of its shorter side, `position(:,1)` or `position(1,:)`; fields of structures have their path, `run.position`.
/// `variable`: the table has the arrays as long as the column of this name; empty: the length that most columns have, the longer of two.
/// `notes` tells what is left out. Throws BadFile if the file is no MATLAB file or has no such array; IoError if it cannot be read.
std::string matlabTable(const std::string& file, const std::string& variable, std::vector<std::string>& notes);

}  // namespace musclesim
