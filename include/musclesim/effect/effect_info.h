/// The catalogue entry of an effect: everything about it that does not need a simulation.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "musclesim/effect/effect.h"
#include "musclesim/robot/robot_effects.h"

namespace musclesim {

/// Neutral value of a parameter that limits something.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Everything about an effect that does not need a simulation. What `musclesim effects ID` prints and a fit needs to know.
struct EffectInfo {
  std::string id;
  Stage stage = Stage::command;
  std::vector<ComponentKind> acts_on;
  std::string summary;    ///< a few words
  std::string equation;   ///< with its letters explained
  std::string signature;  ///< what tells it from look-alikes
  std::string source;
  std::vector<EffectParameter> parameters;
  std::function<std::unique_ptr<Effect>(const EffectValues&)> make;
  /// Given: how far beside its place the robot builds an end of the muscle, along the lever arm and upward.
  std::function<Eigen::Vector2d(const EffectValues&, MuscleEnd)> mount_offset_mm = {};
  /// Whether an effect of the command or pressure stage never asks for lengths, forces or poses. Then pressures can be predicted with a
  /// body that stands still (SimulationOptions::body_moves).
  bool ignores_motion = false;
  /// Whether effectCatalogue() lists the effect, so that `musclesim effects` shows it and a diagnosis looks for it.
  bool listed = true;
};

}  // namespace musclesim
