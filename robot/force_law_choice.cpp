#include "musclesim/robot/force_law_choice.h"

#include "musclesim/robot/chou_hannaford.h"
#include "musclesim/robot/force_map.h"
#include "musclesim/robot/sarosi.h"

namespace musclesim {

const std::vector<std::string>& forceLawNames() {
  static const std::vector<std::string> names = {"braun", "chou-hannaford", "sarosi", "map"};
  return names;
}

std::unique_ptr<ForceLaw> makeForceLaw(Parameters& parameters, double minimum_length_mm, double maximum_length_mm) {
  const std::string name =
      parameters.choice("force_law.name", forceLawNames().front(), forceLawNames(), "law of tension over pressure and length");
  const double given_rest_mm = parameters.number("force_law.rest_length_mm", 0, "mm", 0, 1e4,
                                                 "length at which the muscles match the law's rest length; 0: their maximum length");
  const double rest_mm = given_rest_mm > 0 ? given_rest_mm : maximum_length_mm;
  if (name == "chou-hannaford") return std::make_unique<ChouHannafordForceLaw>(rest_mm, ChouHannafordConstants(parameters));
  if (name == "sarosi") return std::make_unique<SarosiForceLaw>(rest_mm, SarosiConstants(parameters));
  if (name == "map") return std::make_unique<ForceMap>(rest_mm, ForceMapTable(parameters));
  const double ratio = parameters.number("force_law.minimum_length_ratio", 0, "", 0, 0.99,
                                         "Eq. 1: l_min over the rest length; 0: the muscles' own minimum length");
  return std::make_unique<BraunForceLaw>(ratio > 0 ? ratio * rest_mm : minimum_length_mm, rest_mm, BraunConstants(parameters));
}

}  // namespace musclesim
