/// A request for an effect, as in an effects file, a recording's sidecar or the options of a simulation.
#pragma once

#include <map>
#include <string>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// The effect, the component it acts on, and its parameters. Parameters that are not given are neutral.
struct ActiveEffect {
  std::string id;
  std::string component = "all";
  std::map<std::string, Parameter::Value> parameters;  ///< numbers (infinity is allowed), or words if the effect has choices

  bool operator==(const ActiveEffect&) const = default;
};

}  // namespace musclesim
