/// The registry of controllers: builds a controller from its name.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/controller/controller.h"

namespace musclesim {

using ControllerFactory = std::function<std::unique_ptr<Controller>(const ControllerRequest&)>;

/// Registers a controller under a name; a later registration of the same name replaces the earlier one. Throws BadParameter if the name or
/// the factory is empty.
void registerController(const std::string& name, const std::string& description, ControllerFactory factory);

/// Registers the class T, which has a constructor that takes a ControllerRequest:
///     registerController<Mine>("mine", "what it does");
template <typename T>
void registerController(const std::string& name, const std::string& description) {
  registerController(name, description, [](const ControllerRequest& request) { return std::make_unique<T>(request); });
}

/// Builds a registered controller. Throws BadParameter if no controller has this name (the message gives the nearest name), if the request
/// has no muscles, names an unknown task or has a target that is not finite; and passes on what the controller's constructor throws.
std::unique_ptr<Controller> makeController(const std::string& name, const ControllerRequest& request);

/// Names of all registered controllers, in alphabetical order.
std::vector<std::string> registeredControllers();

/// The description under which a controller was registered. Throws BadParameter if no controller has this name.
std::string controllerDescription(const std::string& name);

}  // namespace musclesim
