#include "matlab.h"
#include "musclesim/base/error.h"

namespace musclesim {

bool isMatlabFile(const std::string& file) {
  return file.ends_with(".mat");
}

std::string matlabTable(const std::string& file, const std::string&, std::vector<std::string>&) {
  throw BadFile(file,
                "is a MATLAB file, and this program was built without libmatio (package libmatio-dev); save the table as text, for example "
                "with MATLAB's writematrix or writetable");
}

}  // namespace musclesim
