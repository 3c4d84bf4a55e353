#include "kind.h"

#include <fmt/format.h>

#include <algorithm>

#include "chance.h"
#include "musclesim/base/error.h"

namespace musclesim::blind {

std::string Kind::verdict() const {
  return most_known > 0 ? "effects_found" : unknown ? "unexplained" : "no_gap";
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {{"null", 0.10, 0, 0, false},   {"single", 0.25, 1, 1, false},    {"double", 0.25, 2, 2, false},
                                        {"triple", 0.20, 3, 3, false}, {"quadruple", 0.10, 4, 5, false}, {"mixed", 0.05, 1, 2, true},
                                        {"open", 0.05, 0, 0, true}};
  return all;
}

const Kind& kindOf(const std::string& name) {
  const auto found = std::ranges::find(kinds(), name, &Kind::name);
  if (found != kinds().end()) return *found;
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.push_back(kind.name);
  throw BadParameter("--kinds", name, fmt::format("be one of {}", fmt::join(names, ", ")));
}

const Kind& drawKind(const std::vector<std::string>& allowed, RandomStream& random) {
  if (!allowed.empty()) return kindOf(oneOf(random, allowed));
  double place = random.uniform();
  for (const Kind& kind : kinds())
    if ((place -= kind.share) < 0) return kind;
  return kinds().back();
}

}  // namespace musclesim::blind
