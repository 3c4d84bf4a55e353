#include "musclesim/controller/controller_registry.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>

#include "musclesim/base/error.h"
#include "musclesim/controller/aasm.h"
#include "musclesim/controller/asm.h"
#include "musclesim/controller/hold.h"
#include "musclesim/controller/position.h"
#include "musclesim/controller/random_pressures.h"
#include "musclesim/controller/replay.h"
#include "musclesim/controller/task.h"
#include "musclesim/controller/test_signal.h"

namespace musclesim {

namespace {

struct Entry {
  std::string description;
  ControllerFactory factory;
};

template <typename T>
std::unique_ptr<Controller> build(const ControllerRequest& request) {
  return std::make_unique<T>(request);
}

/// The controllers by name. Guarded by a mutex, because simulations run in several threads.
struct Registry {
  Registry() {
    for (const TestSignalInfo& signal : testSignals())
      entries[signal.name] = {signal.description, [name = signal.name](const ControllerRequest& request) {
                                return std::make_unique<TestSignalController>(name, request);
                              }};
  }

  std::mutex mutex;
  std::map<std::string, Entry> entries = {
      {"aasm", {"attractor selection with attractors that learn during operation", build<AasmController>}},
      {"asm", {"attractor selection by fluctuation (Eq. 5-9)", build<AsmController>}},
      {"hold", {"constant pressures", build<HoldController>}},
      {"position", {"joint angles or the hand's height follow a target, by antagonists", build<PositionController>}},
      {"random", {"new random pressures at every decision, the baseline", build<RandomPressuresController>}},
      {"schedule", {"the commands of a recording or a table (--commands)", build<ReplayController>}},
  };
};

Registry& registry() {
  static Registry the_registry;
  return the_registry;
}

void requireUsable(const ControllerRequest& request) {
  if (request.muscle_count < 1) throw BadParameter("muscle count", fmt::format("{}", request.muscle_count), "be at least 1");
  Task::requireKnown(request.task);
  if (request.target_mm && !request.target_mm->allFinite()) throw BadParameter("target: all coordinates must be finite");
}

Entry entryOf(const std::string& name) {
  auto& [mutex, entries] = registry();
  {
    const std::lock_guard lock(mutex);
    if (const auto found = entries.find(name); found != entries.end()) return found->second;
  }
  const auto known = registeredControllers();
  const std::string nearest = nearestName(name, known);
  throw BadParameter("controller", name,
                     fmt::format("be one of {}{}", fmt::join(known, ", "), nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

}  // namespace

void registerController(const std::string& name, const std::string& description, ControllerFactory factory) {
  if (name.empty() || !factory) throw BadParameter("a controller needs a name and a factory");
  auto& [mutex, entries] = registry();
  const std::lock_guard lock(mutex);
  entries[name] = {description, std::move(factory)};
}

std::unique_ptr<Controller> makeController(const std::string& name, const ControllerRequest& request) {
  const ControllerFactory factory = entryOf(name).factory;
  requireUsable(request);
  return factory(request);
}

std::vector<std::string> registeredControllers() {
  auto& [mutex, entries] = registry();
  const std::lock_guard lock(mutex);
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries) names.push_back(name);
  return names;
}

std::string controllerDescription(const std::string& name) {
  return entryOf(name).description;
}

namespace {

thread_local Controller* active_controller = nullptr;

}  // namespace

Controller* Controller::getActiveController() {
  if (!active_controller) throw BadParameter("this thread has no current simulation with a controller");
  return active_controller;
}

void Controller::setActiveController(Controller* controller) {
  active_controller = controller;
}

}  // namespace musclesim
