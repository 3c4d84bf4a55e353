/// Writes new golden trajectories of rig and elbow, computed with dWorldStep. Use it only after an intended change of the model:
///     cmake --build build --target make_golden && build/tests/golden/make_golden tests/golden/data
#include <cstdio>
#include <exception>
#include <filesystem>

#include "golden.h"

int main(int argument_count, char** arguments) {
  using namespace musclesim;
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: make_golden FOLDER\n");
    return 2;
  }
  try {
    for (const char* robot : {"rig", "elbow"}) {
      ReplayResult result = replayRecording(goldenCommands(robot), goldenOptions(StepperKind::ode));
      if (result.divergence) throw BadParameter(*result.divergence);
      result.simulated.info.description = "golden trajectory, written by tests/golden/make_golden.cpp";
      writeRecording(result.simulated, (std::filesystem::path(arguments[1]) / (std::string(robot) + ".csv")).string());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_golden: %s\n", error.what());
    return 1;
  }
  return 0;
}
