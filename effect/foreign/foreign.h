/// Foreign laws by stage; see musclesim/effect/foreign.h.
#pragma once

#include "musclesim/effect/foreign.h"

namespace musclesim::foreign {

std::vector<ForeignEffect> commandLaws();
std::vector<ForeignEffect> pressureLaws();
std::vector<ForeignEffect> forceLaws();
std::vector<ForeignEffect> bodyLaws();
std::vector<ForeignEffect> sensorLaws();
/// Causes that the catalogue does not have.
std::vector<ForeignEffect> openEffects();

/// What all entries have in common. `id` without the prefix.
inline EffectInfo entry(const std::string& id, Stage stage, std::vector<ComponentKind> acts_on, const std::string& equation,
                        std::vector<EffectParameter> parameters, std::function<std::unique_ptr<Effect>(const EffectValues&)> make) {
  return {.id = "foreign." + id,
          .stage = stage,
          .acts_on = std::move(acts_on),
          .summary = "foreign law for checks",
          .equation = equation,
          .signature = "for checks of a diagnosis only",
          .source = "see the header of the file",
          .parameters = std::move(parameters),
          .make = std::move(make)};
}

/// A number between -1 and 1 that changes smoothly and at random: straight lines between values drawn every `interval_s`.
double wander(std::uint64_t seed, double time_s, double interval_s);

}  // namespace musclesim::foreign
