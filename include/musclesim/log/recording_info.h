/// What the sidecar of a recording says about the plant and the run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/parameters.h"
#include "musclesim/log/active_effect.h"

namespace musclesim {

/// The contents of the sidecar. Only `format` and `robot` are required in the file.
struct RecordingInfo {
  std::string robot;       ///< a name or, if it ends in ".toml", the path of a robot file; the file has it relative to its own folder
  std::string robot_hash;  ///< of the robot file's text, empty: not known
  std::optional<std::string> physics;                        ///< "si", "original" or "scaled"
  std::optional<std::string> initial_state;                  ///< "settled" or "built"
  std::map<std::string, Parameter::Value> robot_parameters;  ///< nested objects are flattened with a dot
  std::vector<std::string> varies;                           ///< robot parameters that may differ between the recordings of one plant
  std::map<std::string, double> parameter_tolerance;         ///< relative standard deviation of what is known of a number; names as above
  std::string description, trial, repeat_of, program;
  std::optional<double> pressure_full_scale_kPa, command_full_scale_V;
  std::map<std::string, double> noise_std;
  std::vector<ActiveEffect> active_effects;  ///< effects that belong to the model: a replay includes them
  std::optional<std::uint64_t> seed;
  std::optional<double> step_s;
  std::optional<double> skip_start_s;  ///< the machine had been moving: a diagnosis leaves out the readings of this time; 0: it had not
  std::optional<bool> complete;        ///< false during a run and after a run that stopped early; absent: not known
  /// All other members of the sidecar, as the JSON text of one object. They are kept when the recording is written again.
  std::string extra_json = "{}";
};

/// The sidecar as indented JSON text. Throws BadParameter if readRecording would refuse its contents.
/// `file`: where it will be, for the way to a robot file; empty: the path is written as it is.
std::string sidecarText(const RecordingInfo& info, const std::string& file = "");

}  // namespace musclesim
