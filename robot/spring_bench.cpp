#include "musclesim/robot/spring_bench.h"

#include <algorithm>
#include <functional>

#include "musclesim/base/units.h"
#include "musclesim/robot/force_law_choice.h"
#include "musclesim/robot/linear_actuator.h"
#include "musclesim/robot/muscle.h"

namespace musclesim {

namespace {

/// An actuator without pressure whose tension follows from its length.
class Spring : public LinearActuator {
 public:
  Spring(dWorldID world, dSpaceID space, const Vector& start, const Vector& end, double maximum_mm, std::function<double(double)> tension_N)
      : LinearActuator(world, space, start, end, 0, maximum_mm), tension_N_(std::move(tension_N)) {
    setName("spring");
  }
  double calculateForce(double, double length_mm) const override { return tension_N_ ? tension_N_(length_mm) : 0; }

 private:
  std::function<double(double)> tension_N_;
};

}  // namespace

SpringBench::SpringBench(World& world) : Robot(world) {
  load_N_ = parameter("spring_bench.load_N", 20, "N", 0, 1e5, "constant load");
  spring_N_per_mm_ = parameter("spring_bench.spring_N_per_mm", 5, "N/mm", 0, 1e5, "stiffness of the spring");
  reference_mm_ = parameter("spring_bench.reference_length_mm", 250, "mm", 15, 1e4, "length of the muscle at which the spring is slack");
  const double rest_mm =
      parameter("spring_bench.rest_length_mm", 250, "mm", 15, 1e4, "length at which the muscle matches the force law's rest length");
  const double minimum_mm = parameter("spring_bench.minimum_length_mm", 150, "mm", 15, 1e4, "muscle: shortest length");
  const double maximum_mm = parameter("spring_bench.maximum_length_mm", 300, "mm", 15, 1e4, "muscle: longest length, a stop");
  const double carriage_kg = parameter("spring_bench.carriage_kg", 0.5, "kg", 1e-4, 1e3, "mass of the carriage");
  const Vector end((minimum_mm + maximum_mm) / 2, 0, 0);
  const Vector start = mountedStart({0, 0, 0}, Vector::UnitY());
  const Vector anchor(2 * maximum_mm, 0, 0);
  constexpr double drawn_mm = 20;
  auto* carriage = new Box(world, nullptr, end, carriage_kg * g_per_kg, 0, drawn_mm, drawn_mm, drawn_mm);
  carriage->setName("carriage");
  carriage->attachSlider(nullptr, Vector::UnitX());
  auto* muscle = new Muscle(world, space(), start, start + (end - start) / 3, start + (end - start) * 2 / 3, end, minimum_mm, maximum_mm);
  muscle->setForceLaw(makeForceLaw(world.parameters(), minimum_mm, rest_mm));
  auto* spring = new Spring(world, space(), end, anchor, 2 * maximum_mm,
                            [this, maximum_mm](double length_mm) { return springN(2 * maximum_mm - length_mm); });
  muscle->connectStartTo(nullptr);
  muscle->connectEndTo(carriage);
  spring->connectStartTo(carriage);
  spring->connectEndTo(nullptr);
  addActuator(muscle);
  setLoad(carriage);
}

double SpringBench::springN(double length_mm) const {
  return std::max(0.0, load_N_ + spring_N_per_mm_ * (reference_mm_ - length_mm));
}

}  // namespace musclesim
