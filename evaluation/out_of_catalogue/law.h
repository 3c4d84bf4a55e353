/// A law that the catalogue does not contain.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/effect/effect_info.h"

namespace musclesim {

/// An effect whose id begins with "foreign.".
struct OutOfCatalogueLaw {
  EffectInfo info;
  std::string stands_for;  ///< the catalogue's id of the same cause; empty: no effect of the catalogue has this cause
};

namespace out_of_catalogue {

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

}  // namespace out_of_catalogue

}  // namespace musclesim
