/// The program `musclesim`.
#include <cstdlib>

#include "musclesim/program.h"

int main(int argument_count, char** arguments) {
  std::_Exit(musclesim::program(argument_count, arguments));  // all files are closed; a cleanup would only take time
}
