#include "musclesim/robot/robot_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <map>
#include <mutex>

#include "file_robot.h"
#include "musclesim/base/error.h"
#include "musclesim/base/file.h"
#include "musclesim/robot/force_law_choice.h"
#include "shipped.h"

namespace musclesim {

namespace {

using description::Description;

constexpr std::size_t file_limit_bytes = std::size_t{1} << 20;

/// Descriptions that have been read, by file: a diagnosis builds the same robot thousands of times, in several threads.
class ReadDescriptions {
 public:
  std::shared_ptr<const Description> read(const std::string& file) {
    std::error_code unknown;
    const Version version = {std::filesystem::last_write_time(file, unknown), std::filesystem::file_size(file, unknown)};
    const std::lock_guard lock(access_);
    Entry& entry = entries_[file];
    if (!entry.description || entry.version != version)
      entry = {version, std::make_shared<const Description>(description::readDescription(readTextFile(file, file_limit_bytes), file))};
    return entry.description;
  }

 private:
  using Version = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  struct Entry {
    Version version;
    std::shared_ptr<const Description> description;
  };
  std::mutex access_;
  std::map<std::string, Entry> entries_;
};

std::shared_ptr<const Description> readOnce(const std::string& file) {
  static ReadDescriptions descriptions;
  return descriptions.read(file);
}

std::unique_ptr<Robot> build(std::shared_ptr<const Description> description, const std::string& file, World& world) {
  const std::string name = description->name;
  const std::string hash = description->hash;
  auto robot = std::make_unique<description::FileRobot>(world, std::move(description));
  robot->setName(name);
  robot->setDescription(file, hash);
  return robot;
}

/// The constants of a law that a muscle does not give, "stretch_N = 49.4", but those whose default is 0.
std::vector<std::string> unstated(const description::ForceLawEntry& law) {
  Parameters all;
  all.set("force_law.name", law.name, "name");
  makeForceLaw(all, 1, 2);  // lengths that any law can have: only the names are of interest
  std::vector<std::string> result;
  for (const Parameter& parameter : all.declared()) {
    const std::string name = parameter.name.substr(std::string("force_law.").size());
    const auto* number = std::get_if<double>(&parameter.default_value);
    if (number && *number != 0 && !law.parameters.contains(name)) result.push_back(fmt::format("{} = {:.4g}", name, *number));
  }
  return result;
}

}  // namespace

std::vector<std::string> unstatedConstants(const std::string& file) {
  const auto description = readOnce(file);
  std::map<std::string, std::vector<std::string>> muscles;  // by what they lack
  for (const auto* entries : {&description->muscles, &description->actuators})
    for (const description::MuscleEntry& muscle : *entries) {
      if (!muscle.force_law || muscle.force_law->name == "map") continue;
      if (const auto lacking = unstated(*muscle.force_law); !lacking.empty())
        muscles[fmt::format("{}", fmt::join(lacking, ", "))].push_back(muscle.name);
    }
  std::vector<std::string> sentences;
  for (const auto& [constants, names] : muscles)
    sentences.push_back(fmt::format("the force law of {} does not say all its constants; those of another muscle hold: {}",
                                    fmt::join(names, ", "), constants));
  return sentences;
}

const std::vector<ShippedRobot>& shippedRobots() {
  static const std::vector<ShippedRobot> robots = [] {
    std::vector<ShippedRobot> read;
    for (const auto& [name, text] : description::shippedFiles())
      read.push_back({name, text, description::readDescription(text, name + ".toml").summary});
    return read;
  }();
  return robots;
}

std::unique_ptr<Robot> makeShippedRobot(const std::string& name, World& world) {
  static const std::map<std::string, std::shared_ptr<const Description>> descriptions = [] {
    std::map<std::string, std::shared_ptr<const Description>> read;
    for (const ShippedRobot& robot : shippedRobots())
      read[robot.name] = std::make_shared<const Description>(description::readDescription(robot.text, robot.name + ".toml"));
    return read;
  }();
  const auto found = descriptions.find(name);
  if (found == descriptions.end()) throw BadParameter("there is no robot \"" + name + "\" that comes with the program");
  try {
    auto robot = std::make_unique<description::FileRobot>(world, found->second);
    robot->setName(name);
    return robot;
  } catch (const BadFile& problem) {
    if (problem.file() != found->second->file) throw;
    throw BadParameter(std::string("parameters of ") + problem.what());  // the file is right, so what overrides its numbers is wrong
  }
}

bool isRobotFile(const std::string& robot) {
  return robot.ends_with(".toml");
}

std::unique_ptr<Robot> makeRobotFromFile(const std::string& file, World& world) {
  return build(readOnce(file), file, world);
}

std::string nameOfRobotFile(const std::string& file) {
  return readOnce(file)->name;
}

std::unique_ptr<Robot> makeRobotFromText(const std::string& text, const std::string& file, World& world) {
  return build(std::make_shared<const Description>(description::readDescription(text, file)), "", world);
}

void checkRobotText(const std::string& text, const std::string& file) {
  description::readDescription(text, file);
}

}  // namespace musclesim
