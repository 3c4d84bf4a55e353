/// The out-of-catalogue laws, one list per stage.
#pragma once

#include <vector>

#include "law.h"

namespace musclesim::out_of_catalogue {

std::vector<OutOfCatalogueLaw> commandLaws();
std::vector<OutOfCatalogueLaw> pressureLaws();
std::vector<OutOfCatalogueLaw> forceLaws();
std::vector<OutOfCatalogueLaw> bodyLaws();
std::vector<OutOfCatalogueLaw> sensorLaws();
/// Laws of causes that are not in the catalogue.
std::vector<OutOfCatalogueLaw> openEffects();

}  // namespace musclesim::out_of_catalogue
