/// The kinds of plant by their causes.
#pragma once

#include <string>
#include <vector>

#include "musclesim/base/random.h"

namespace musclesim::blind {

/// One kind of plant. A known cause has an effect in the catalogue that stands for it, an unknown one has none.
struct Kind {
  std::string name;
  double share = 0;  ///< of all plants, unless others are asked for
  int least_known = 0, most_known = 0;
  bool unknown = false;
  /// Whether several causes act.
  bool isSeveral() const { return most_known + (unknown ? 1 : 0) > 1; }
  /// The verdict that is right: no_gap, unexplained or effects_found.
  std::string verdict() const;
};

/// null, single, double, triple, quadruple (four or five causes), mixed (one or two known causes beside an unknown one), open (an unknown
/// cause alone). Their shares are those of a benchmark of plants as real machines are.
const std::vector<Kind>& kinds();
/// Throws BadParameter with the names of all kinds.
const Kind& kindOf(const std::string& name);
/// One of the allowed kinds with equal odds; if none are given, one of all kinds by their shares.
const Kind& drawKind(const std::vector<std::string>& allowed, RandomStream& random);

}  // namespace musclesim::blind
