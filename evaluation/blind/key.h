/// What the key says of a plant.
#pragma once

#include <nlohmann/json.hpp>

#include "plant.h"

namespace musclesim::blind {

/// The key of a case: kind, causes with their laws and contributions, the answers that count as right, the numbers of plant and model, gap,
/// and what the known causes' laws remove of it in the last recording while the model keeps its own numbers (`oracle_shrink_percent`).
nlohmann::json keyOf(const Plant& plant, const Robot& robot);

}  // namespace musclesim::blind
