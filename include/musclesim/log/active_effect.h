/// An effect as it is asked for: in an effects file, in a recording's sidecar, in the options of a simulation.
#pragma once

#include <map>
#include <string>

#include "musclesim/base/parameters.h"

namespace musclesim {

/// Which effect, on which component, how strong. Parameters that are not named are neutral.
struct ActiveEffect {
  std::string id;
  std::string component = "all";
  std::map<std::string, Parameter::Value> parameters;  ///< numbers, infinity included, or words where the effect has choices

  bool operator==(const ActiveEffect&) const = default;
};

}  // namespace musclesim
