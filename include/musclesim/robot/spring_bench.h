/// A spring test stand: one muscle pulls a carriage against a spring and a constant load.
#pragma once

#include "musclesim/robot/robot.h"

namespace musclesim {

/// The muscle lies along +x from the origin to a carriage on a frictionless slider; on the other side the carriage is pulled with the force
///     R = max(0, load_N + spring_N_per_mm (reference_length_mm - l)),   l the length of the muscle.
/// The force law's rest length is rest_length_mm.
/// Parameters: spring_bench.load_N 20, spring_bench.spring_N_per_mm 5, spring_bench.reference_length_mm 250,
/// spring_bench.rest_length_mm 250, spring_bench.minimum_length_mm 150, spring_bench.maximum_length_mm 300,
/// spring_bench.carriage_kg 0.5.
class SpringBench : public Robot {
 public:
  explicit SpringBench(World& world);
  std::string initialState() const override { return "settled"; }

 private:
  double springN(double length_mm) const;

  double load_N_, spring_N_per_mm_, reference_mm_;
};

}  // namespace musclesim
