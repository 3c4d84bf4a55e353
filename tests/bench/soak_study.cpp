/// A long run in one process: memory and open files must not grow. Usage: soak_study [steps = 1000000]
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "musclesim/base/random.h"
#include "musclesim/log/recorder.h"
#include "musclesim/simulation/simulation.h"

using namespace musclesim;

namespace {

/// Resident memory, KiB (/proc/self/statm, second number, in pages).
long residentKiB() {
  std::ifstream statm("/proc/self/statm");
  long total = 0, resident = 0;
  statm >> total >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

long openFiles() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

}  // namespace

int main(int argument_count, char** arguments) {
  const long step_count = argument_count > 1 ? std::stol(arguments[1]) : 1'000'000, warm_up = step_count / 20;
  SimulationOptions options;
  options.parameters.set("muscle.model", std::string("line"), "soak_study");
  Simulation simulation(options);
  Robot& robot = simulation.build("elbow");
  const std::string file = (std::filesystem::temp_directory_path() / fmt::format("soak_{}.csv", getpid())).string();
  RecordingInfo info;
  info.robot = "elbow";
  Recorder recorder(file, info, robot.signalNames());
  RandomStream random(1, "soak.pressures");
  simulation.start("built", {0.2, 0.2});
  long memory_KiB = 0, files = 0, largest_KiB = 0;
  for (long step = 0; step < step_count; ++step) {
    if (step % 100 == 0) robot.step({random.uniform(0, 0.6), random.uniform(0, 0.6)});
    if (step % 10 == 0) recorder.append(simulation.time_s(), robot.signalValues(robot.getState()));
    simulation.step();
    if (step == warm_up) memory_KiB = residentKiB(), files = openFiles();
    if (step > warm_up && step % 10000 == 0) largest_KiB = std::max(largest_KiB, residentKiB() - memory_KiB);
  }
  const long grown_files = openFiles() - files;
  recorder.close(true);
  std::filesystem::remove(file);
  std::filesystem::remove(sidecarPath(file));
  fmt::print("{} steps of the elbow with a recording: memory grew by {} KiB at most after the first {} steps, open files by {}\n",
             step_count, largest_KiB, warm_up, grown_files);
  return largest_KiB < 1024 && grown_files == 0 ? 0 : 1;
}
