/// The out-of-catalogue laws by stage.
#pragma once

#include "out_of_catalogue.h"

namespace musclesim::out_of_catalogue {

std::vector<OutOfCatalogueLaw> commandLaws();
std::vector<OutOfCatalogueLaw> pressureLaws();
std::vector<OutOfCatalogueLaw> forceLaws();
std::vector<OutOfCatalogueLaw> bodyLaws();
std::vector<OutOfCatalogueLaw> sensorLaws();
/// Laws whose cause the catalogue does not have.
std::vector<OutOfCatalogueLaw> openEffects();

/// What all entries have in common. `id` without the prefix.
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

/// A number between -1 and 1 that changes smoothly and at random: straight lines between values drawn every `interval_s`.
double wander(std::uint64_t seed, double time_s, double interval_s);

}  // namespace musclesim::out_of_catalogue
