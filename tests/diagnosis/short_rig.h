/// Two short recordings of a rig, both for fitting.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "diagnosis/fit/comparison.h"
#include "planted.h"

namespace musclesim::planted {

class ShortRig : public testing::Test {
 protected:
  explicit ShortRig(const std::vector<ActiveEffect>& effects = {}, double amplitude = 0.1)
      : plant({recorded(effects, amplitude, 1), recorded(effects, 1.3 * amplitude, 2)}, options), both(plant, {{0, 0, 150}, {1, 0, 150}}) {}

  DiagnosisOptions options;
  Plant plant;
  Comparison both;
};

}  // namespace musclesim::planted
