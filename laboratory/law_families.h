/// The families of force laws by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "law_model.h"

namespace musclesim {

/// Names of all families: braun, chou-hannaford-linear (the four constants A, B, C, D), chou-hannaford (A, B, D, E, beta), sarosi, map.
const std::vector<std::string>& lawModelNames();

/// Throws BadParameter with the nearest name if there is no family of that name.
std::unique_ptr<LawModel> makeLawModel(const std::string& name, const Specimen& specimen, const BraunLengths& lengths);

}  // namespace musclesim
