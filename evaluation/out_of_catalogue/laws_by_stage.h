/// The out-of-catalogue laws, one list per stage.
#pragma once

#include "out_of_catalogue.h"

namespace musclesim::out_of_catalogue {

std::vector<OutOfCatalogueLaw> commandLaws();
std::vector<OutOfCatalogueLaw> pressureLaws();
std::vector<OutOfCatalogueLaw> forceLaws();
std::vector<OutOfCatalogueLaw> bodyLaws();
std::vector<OutOfCatalogueLaw> sensorLaws();
/// Laws of causes that are not in the catalogue.
std::vector<OutOfCatalogueLaw> openEffects();

/// An entry with the fields that all laws have in common. `id` comes without the prefix.
inline EffectInfo entry(const std::string& id, Stage stage, std::vector<ComponentKind> acts_on, const std::string& equation,
                        std::vector<EffectParameter> parameters, std::function<std::unique_ptr<Effect>(const EffectValues&)> make) {
  return {.id = "foreign." + id,
          .stage = stage,
          .acts_on = std::move(acts_on),
          .summary = "law outside the catalogue, for checks of the diagnosis",
          .equation = equation,
          .signature = "for checks of a diagnosis only",
          .source = "see the header of the file",
          .parameters = std::move(parameters),
          .make = std::move(make),
          .listed = false};
}

/// A random function of time between -1 and 1: linear interpolation between random values every `interval_s`.
double wander(std::uint64_t seed, double time_s, double interval_s);

}  // namespace musclesim::out_of_catalogue
