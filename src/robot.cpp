/// `musclesim robot`: checks, shows, begins, exports and imports robot files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "../import/import.h"
#include "../robot/inspection.h"
#include "../robot/robotic_arm_file.h"
#include "commands.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/base/text.h"
#include "musclesim/robot/robot_file.h"
#include "musclesim/simulation/replay.h"
#include "pictures.h"
#include "robot_template.h"

namespace musclesim::command_line {

namespace {

namespace fs = std::filesystem;

/// A simulation with the robot as built, to look at; a number may have another value.
std::unique_ptr<Simulation> built(const ModelOptions& model, const std::string& robot,
                                  const std::optional<std::pair<std::string, double>>& changed = {}) {
  if (model.robot) throw BadParameter("--robot", *model.robot, "be left out: the robot is the argument after the sub-command");
  ReplayOptions options = replayOptionsFrom(model);
  if (changed) options.parameters.set(changed->first, changed->second, "robot check");
  RecordingInfo plant;
  plant.robot = robot;
  auto simulation = std::make_unique<Simulation>(simulationOptionsFor(plant, robot, options));
  simulation->build(robot);
  simulation->parameters().requireAllKnown();
  return simulation;
}

void printOddities(const std::vector<std::string>& found) {
  for (const std::string& oddity : found) fmt::print("odd: {}\n", oddity);
}

/// Muscles rub although no robot file says so.
void printFriction(const Robot& robot) {
  std::set<double> frictions_N;
  bool has_chain = false;
  for (const Actuator* muscle : robot.actuators()) {
    frictions_N.insert(muscle->settings().slider_friction_N);
    has_chain = has_chain || !muscle->line();
  }
  if (!frictions_N.empty())
    fmt::print("friction within the muscles: {:.4g} N (muscle.slider_friction_N{})\n", fmt::join(frictions_N, ", "),
               has_chain ? "; in each link of a chain" : "");
}

/// How far numbers may be off. A diagnosis may take another number that is wrong for a cause.
void printTolerances(const Robot& robot) {
  std::vector<std::string> words;
  for (const auto& [name, tolerance] : robot.parameterTolerances()) words.push_back(fmt::format("{} {:.3g} %", name, 100 * tolerance));
  fmt::print("tolerances for a diagnosis: {}; every other number, levers and places too, counts as exact\n",
             words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", ")));
}

/// All readings after a short motion under commands that differ from muscle to muscle; none if the robot cannot be built with the changed
/// number, or cannot move.
std::vector<double> readingsAfterMotion(const ModelOptions& model, const std::string& name,
                                        const std::optional<std::pair<std::string, double>>& changed = {}) {
  constexpr double duration_s = 0.2, least_command = 0.2, spread = 0.5;
  try {
    const auto simulation = built(model, name, changed);
    Robot& robot = simulation->robot();
    const int count = robot.actuatorCount();
    musclesim::Action command(static_cast<std::size_t>(count), least_command);
    simulation->start(robot.initialState(), command);
    for (int i = 0; i < count; ++i) command[static_cast<std::size_t>(i)] += spread * i / count;
    for (robot.step(command); simulation->time_s() < duration_s;) simulation->step();
    const State state = robot.getState();
    std::vector<double> readings = state.angle_deg;
    for (const auto* more : {&state.force_N, &state.length_mm, &state.pressure})
      readings.insert(readings.end(), more->begin(), more->end());
    if (state.hand_mm) readings.insert(readings.end(), state.hand_mm->data(), state.hand_mm->data() + state.hand_mm->size());
    return readings;
  } catch (const Error&) {
    return {};
  }
}

/// Numbers with a tolerance that do not matter, because every muscle has a force law or settings of its own.
std::vector<std::string> tolerancesForNothing(const ModelOptions& model, const std::string& robot, Simulation& simulation) {
  std::vector<std::string> found;
  const std::map<std::string, double> tolerances = simulation.robot().parameterTolerances();
  const std::vector<double> before = tolerances.empty() ? std::vector<double>{} : readingsAfterMotion(model, robot);
  if (before.empty()) return found;
  const std::vector<Parameter> declared = simulation.parameters().declared();
  for (const auto& [name, tolerance] : tolerances) {
    const auto number = std::ranges::find(declared, name, &Parameter::name);
    if (number == declared.end() || !std::holds_alternative<double>(number->value)) continue;
    const double given = std::get<double>(number->value);
    const double value = given * (given * (1 + tolerance) <= number->maximum ? 1 + tolerance : 1 / (1 + tolerance));
    if (readingsAfterMotion(model, robot, std::pair{name, value}) == before)
      found.push_back(fmt::format("{} changes nothing in a short motion: its tolerance may be of no use", name));
  }
  return found;
}

int check(const ModelOptions& model, const std::string& robot) {
  const auto simulation = built(model, robot);
  const Robot& made = simulation->robot();
  made.requireTolerances();
  fmt::print("{}: {} bodies, {} joints with a reported angle, {} muscles; starts {}\n", printable(robot),
             simulation->world().bodies().size(), made.angles().size(), made.actuatorCount(), made.initialState());
  auto found = oddities(simulation->world(), made);
  if (isRobotFile(robot)) std::ranges::move(unstatedConstants(robot), std::back_inserter(found));
  if (made.initialState() == "settled") simulation->settle(musclesim::Action(static_cast<std::size_t>(made.actuatorCount()), 0.0));
  std::ranges::move(tolerancesForNothing(model, robot, *simulation), std::back_inserter(found));
  printFriction(made);
  printTolerances(made);
  printOddities(found);
  if (found.empty()) fmt::print("nothing odd found\n");
  return done;
}

struct ShowArguments {
  std::string robot;
  std::optional<std::string> out;
  PictureOptions pictures;
};

int show(const ModelOptions& model, const ShowArguments& arguments) {
  auto simulation = built(model, arguments.robot);
  fmt::print("{}", describeRobot(simulation->world(), simulation->robot()));
  const fs::path stem = arguments.out.value_or(simulation->robot().name());
  PictureOptions pictures = arguments.pictures;
  if (!pictures.screenshot) pictures.screenshot = stem.string() + ".png";
  const auto painter = makePictures(pictures, *simulation);
  painter->see(simulation->robot().getState());
  painter->finish();
  std::vector<MomentArms> arms;
  try {
    arms = momentArms(simulation->world(), simulation->robot());
  } catch (const BadParameter& problem) {
    fmt::print("no moment arms: {}\n", problem.what());
  }
  if (arms.empty()) return done;
  const std::string figure = stem.string() + "-moment-arms.svg";
  replaceFile(figure, momentArmFigure(arms, simulation->robot()));
  fmt::print("moment arms {}\n", printable(figure));
  return done;
}

/// Writes a robot file that must not exist yet, or to standard output.
void write(const std::optional<std::string>& out, const std::string& text) {
  if (!out) {
    fmt::print("{}", text);
    return;
  }
  FileReplacement file(*out, text);
  if (!file.commitIfAbsent()) throw BadParameter("file", *out, "not exist yet: choose another name or remove it");
  fmt::print("robot file {}\n", printable(*out));
}

int begin(const std::string& robot, const std::optional<std::string>& out) {
  const fs::path file = robot;
  const std::string name = file.extension() == ".toml" ? file.stem().string() : robot;
  write(out.value_or(file.extension() == ".toml" ? robot : name + ".toml"), robotTemplate(name));
  return done;
}

int exportRobot(const std::string& name, const std::optional<std::string>& out) {
  std::vector<std::string> known = {"arm"};
  for (const ShippedRobot& shipped : shippedRobots()) {
    known.push_back(shipped.name);
    if (shipped.name == name) return write(out, shipped.text), done;
  }
  if (name != "arm") throw BadParameter("robot", name, fmt::format("be one of {}", fmt::join(known, ", ")));
  write(out, roboticArmFile());
  return done;
}

int import(const std::string& file, const std::optional<std::string>& out) {
  const ImportedRobot robot = importRobot(file);
  const std::string target = out.value_or(fs::path(file).stem().string() + ".toml");
  write(target, robot.toml);
  for (const std::string& note : robot.notes) fmt::print("note: {}\n", note);
  return done;
}

}  // namespace

Action addRobot(CLI::App& command, ModelOptions& model) {
  command.require_subcommand(1);
  auto action = std::make_shared<Action>();
  const auto sub = [&](const char* name, const char* description) { return command.add_subcommand(name, description); };

  auto robot = std::make_shared<std::string>();
  CLI::App* checks = sub("check", "Builds a robot and says what is odd about it");
  checks->add_option("robot", *robot, "Robot file, or the name of a robot: NAME.toml")->required();
  addModelOptions(*checks, model);
  checks->callback([=, &model] { *action = [=, &model] { return check(model, *robot); }; });

  auto shown = std::make_shared<ShowArguments>();
  CLI::App* shows = sub("show", "Prints a robot's bodies, joints and muscles and draws it, with the muscles' moment arms");
  shows->add_option("robot", shown->robot, "Robot file, or the name of a robot: NAME.toml")->required();
  shows->add_option("--out", shown->out, "Begin of the names of the pictures: STEM.png, STEM-moment-arms.svg (default: the robot's name)");
  addModelOptions(*shows, model);
  addPictureOptions(*shows, shown->pictures, "Picture");
  shows->callback([=, &model] { *action = [=, &model] { return show(model, *shown); }; });

  auto name = std::make_shared<std::string>();
  auto out = std::make_shared<std::optional<std::string>>();
  CLI::App* begins = sub("new", "Writes a commented robot file to begin with");
  begins->add_option("name", *name, "Name of the robot, or its file: NAME.toml")->required();
  begins->add_option("-o,--out", *out, "File to write (default: NAME.toml)");
  begins->callback([=] { *action = [=] { return begin(*name, *out); }; });

  CLI::App* exports = sub("export", "Writes the file of a robot that comes with the program");
  exports->add_option("name", *name, "arm, rig, elbow, wrist, pulley_arm or spring_bench")->required();
  exports->add_option("-o,--out", *out, "File to write (default: standard output)");
  exports->callback([=] { *action = [=] { return exportRobot(*name, *out); }; });
  CLI::App* imports = sub("import", "Turns a robot description of another program (URDF, SDF, MJCF) into a robot file");
  imports->add_option("file", *name, "Description to read: FILE.urdf, FILE.sdf or FILE.xml")->required();
  imports->add_option("-o,--out", *out, "File to write (default: the same name with .toml, in this folder)");
  imports->callback([=] { *action = [=] { return import(*name, *out); }; });
  return [action] { return (*action)(); };
}

}  // namespace musclesim::command_line
