#include "fuzz/targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>

#include "controller/targets.h"
#include "import/import.h"
#include "laboratory/point_reader.h"
#include "log/data_table.h"
#include "log/matlab.h"
#include "log/table_look.h"
#include "musclesim/base/error.h"
#include "musclesim/base/json_document.h"
#include "musclesim/base/parameters.h"
#include "musclesim/controller/replay.h"
#include "musclesim/effect/effects_file.h"
#include "musclesim/log/import.h"
#include "musclesim/log/recording.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/simulation.h"
#include "src/command_line.h"
#include "src/run_origin.h"
#include "sweep/plan.h"
#include "sweep/sweep.h"

namespace musclesim {

namespace {

const std::string plain_csv = "time_s,command_0,pressure_0,length_0_mm\n0,0,0,200\n0.01,0.5,0.5,199\n";
const std::string plain_sidecar = R"({"format": "musclesim-recording-1", "robot": "rig"})";

[[noreturn]] void wrong(const std::string& what) {
  std::fprintf(stderr, "fuzz target: %s\n", what.c_str());
  std::abort();
}

/// Runs a reader. A BadFile must name the file, and the line if a single byte is at fault.
void read(const std::function<void()>& reader) {
  try {
    reader();
  } catch (const BadFile& error) {
    if (error.file().empty() || std::string(error.what()).find(error.file()) != 0) wrong(std::string("no file in: ") + error.what());
    if (error.line() < 0 || error.column() < 0 || (error.column() > 0 && error.line() == 0))
      wrong(std::string("no place in: ") + error.what());
  } catch (const Error&) {
  }
}

/// Writes the parsed value and reads it again; both must be equal.
void requireSame(const std::string& first, const std::string& again) {
  if (first != again) wrong("reading what was written gives something else:\n" + first + "\n" + again);
}

void recordingCsv(const std::string& bytes) {
  read([&] { parseRecording(bytes, "r.csv", plain_sidecar, "r.json"); });
}

void robotToml(const std::string& bytes) {
  read([&] { checkRobotText(bytes, "robot.toml"); });
}

void sidecarJson(const std::string& bytes) {
  read([&] {
    const Recording recording = parseRecording(plain_csv, "r.csv", bytes, "r.json");
    const std::string text = sidecarText(recording.info);
    requireSame(text, sidecarText(parseRecording(plain_csv, "r.csv", text, "r.json").info));
  });
}

/// An anonymous file, because the reader of configurations needs a path.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& bytes) : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0 || write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) wrong("no memory file");
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void configurationToml(const std::string& bytes) {
  read([&] {
    Parameters parameters;
    parameters.readToml(MemoryFile(bytes).path());
    parameters.number("rig.load_kg", 2, "kg", 0, 1000, "load");
    parameters.integer("arm.muscle_count", 10, 1, 30, "muscles");
    parameters.choice("muscle.model", "chain", {"chain", "line"}, "model");
    const std::string text = parameters.toToml();
    parameters.requireAllKnown();
    Parameters again;
    again.readToml(MemoryFile(text).path());
    again.number("rig.load_kg", 2, "kg", 0, 1000, "load");
    again.integer("arm.muscle_count", 10, 1, 30, "muscles");
    again.choice("muscle.model", "chain", {"chain", "line"}, "model");
    requireSame(text, again.toToml());
  });
}

/// Whatever is recognised in a table, the mapping begun from it can be read, and the table can be read by it.
void foreignTable(const std::string& bytes) {
  read([&] {
    const MemoryFile table(bytes);
    const TableLook look = lookAtTable(table.path());
    lookText(look);
    const ImportMapping mapping = readImportMapping(MemoryFile(mappingText(look)).path());
    const DataTable again(table.path(), mapping.format);
    if (again.rowCount() != look.row_count) wrong("the mapping gives another number of rows");
  });
}

/// A table that a mapping can take apart in most ways.
const std::string logged_table =
    "t,date,a,b,c,word\n0,2026-03-01T00:00:00,0.1,0.2,20,--\n0.5,2026-03-01T00:00:00.5,0.3,0.4,21,x\n1,2026-03-01T00:00:01,0.5,0.6,,x\n";

void mappingToml(const std::string& bytes) {
  read([&] { importTable(MemoryFile(logged_table).path(), readImportMapping(MemoryFile(bytes).path())); });
}

/// A crash of libmatio is an answer: it reads in a process of its own.
void matlabBinary(const std::string& bytes) {
  read([&] {
    std::vector<std::string> notes;
    matlabTable(MemoryFile(bytes).path(), "", notes);
  });
}

void commandsCsv(const std::string& bytes) {
  read([&] {
    ReplayController controller(readCommands(MemoryFile(bytes).path()), 2);
    State state;
    for (const double time_s : {0.0, 0.015, 1e300}) {
      state.time_s = time_s;
      for (const double command : controller.output(state))
        if (!(command >= 0 && command <= 1)) wrong("a command outside of 0 .. 1");
    }
  });
}

void targetsCsv(const std::string& bytes) {
  read([&] {
    const MemoryFile file(bytes);
    const TargetTable table(file.path());
    for (const char* joint : {"elbow", ""}) table.at(table.column(joint), table.endS());
  });
}

void staticPointsCsv(const std::string& bytes) {
  read([&] { readStaticPoints(MemoryFile(bytes).path(), {}); });
}

/// A robot of another program: what comes out is a robot file that can be read. For three targets, whose corpora differ.
void foreignRobot(const std::string& bytes) {
  read([&] {
    const ImportedRobot robot = importRobot(MemoryFile(bytes).path());
    try {
      checkRobotText(robot.toml, "made.toml");
    } catch (const BadFile& error) {
      wrong(std::string("a robot was made that cannot be read: ") + error.what());
    }
  });
}

/// The robot is built, with all its expressions, and stands for a step.
void robotBuilt(const std::string& bytes) {
  read([&] {
    Simulation simulation;
    makeRobotFromText(bytes, "robot.toml", simulation.world())->getState();
  });
}

void originJson(const std::string& bytes) {
  read([&] {
    const auto json = JsonDocument(bytes, "r.json").root();
    const auto origin = command_line::originFromJson(json, "r.json");
    command_line::argumentsWithCopies(origin, "/nonexistent", "r.json");
    requireSame(command_line::jsonOf(origin).dump(),
                command_line::jsonOf(command_line::originFromJson(command_line::jsonOf(origin), "")).dump());
  });
}

void effectsJson(const std::string& bytes) {
  read([&] {
    const auto effects = parseEffects(bytes, "effects.json");
    requireSame(effectsText(effects), effectsText(parseEffects(effectsText(effects), "effects.json")));
  });
}

void sweepManifest(const std::string& bytes) {
  read([&] { parseSweep(bytes, "manifest.json"); });
}

void sweepPlan(const std::string& bytes) {
  read([&] { parsePlan(bytes, "plan.toml"); });
}

/// Splits the input into arguments at line ends.
void commandLine(const std::string& bytes) {
  std::vector<std::string> arguments = {"musclesim"};
  for (std::size_t at = 0; at < bytes.size() && arguments.size() < 100;) {
    const auto end = std::min(bytes.find('\n', at), bytes.size());
    arguments.push_back(bytes.substr(at, end - at).c_str());  // an argument ends at its first NUL
    at = end + 1;
  }
  std::vector<const char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  command_line::CommandLine command_line;
  read([&] { command_line.parse(static_cast<int>(pointers.size()), pointers.data()); });
}

}  // namespace

const std::vector<std::pair<std::string, FuzzTarget>>& fuzzTargets() {
  static const std::vector<std::pair<std::string, FuzzTarget>> targets = {
      {"recording_csv", recordingCsv}, {"sidecar_json", sidecarJson},      {"configuration_toml", configurationToml},
      {"effects_json", effectsJson},   {"sweep_manifest", sweepManifest},  {"sweep_plan", sweepPlan},
      {"foreign_table", foreignTable}, {"command_line", commandLine},      {"robot_toml", robotToml},
      {"mapping_toml", mappingToml},   {"matlab", matlabBinary},           {"commands_csv", commandsCsv},
      {"targets_csv", targetsCsv},     {"static_points", staticPointsCsv}, {"robot_urdf", foreignRobot},
      {"robot_mjcf", foreignRobot},    {"robot_sdf", foreignRobot},        {"robot_built", robotBuilt},
      {"run_origin", originJson},
  };
  return targets;
}

}  // namespace musclesim
