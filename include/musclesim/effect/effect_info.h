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

/// Choices of an effect's parameters that a fit cannot reach from each other: a diagnosis tries each by itself.
enum class Variants {
  shares,     ///< with and without the parameters that are shares and may be zero (further lags, a filter)
  laws,       ///< the first strength with and without the shares, and each further one alone: each is a law of its own
  strengths,  ///< all strengths together, and each alone
  sizes,      ///< small and large: these show differently
  bits,       ///< every number of bits, and how a converter rounds
  ends,       ///< either end of a muscle
  sides,      ///< either side of every axis
  stops,      ///< hard stops, and stops that give way
};

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
  Variants variants = Variants::shares;
  /// Whether the parameters are the constants of another force law, of which none is neutral.
  bool replaces_law = false;
  /// Of the sensor stage: whether a reading is a function of the value alone, at any time and of any signal. Then it can be taken from a
  /// simulation without the effect; SensorEffect::reading() is asked without attach().
  bool is_memoryless = false;
  /// Of the sensor stage: whether one cause may disturb all readings alike, such as a logger's clock.
  bool may_be_shared = false;
  /// Whether effectCatalogue() lists the effect, so that `musclesim effects` shows it and a diagnosis looks for it.
  bool listed = true;
};

}  // namespace musclesim
