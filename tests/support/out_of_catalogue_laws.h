/// For tests that simulate with laws outside the catalogue: including this header registers them.
#pragma once

#include "evaluation/out_of_catalogue/out_of_catalogue.h"

namespace musclesim {

inline const bool out_of_catalogue_laws_are_registered = [] {
  registerOutOfCatalogueLaws();
  return true;
}();

}  // namespace musclesim
