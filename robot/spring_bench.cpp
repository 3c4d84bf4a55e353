#include "musclesim/robot/spring_bench.h"

#include <algorithm>
#include <functional>

#include "equilibrium.h"
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
  start_mm_ = mountedStart({0, 0, 0}, Vector::UnitY());
  anchor_mm_ = {2 * maximum_mm, 0, 0};
  constexpr double drawn_mm = 20;
  carriage_ = new Box(world, nullptr, end, carriage_kg * g_per_kg, 0, drawn_mm, drawn_mm, drawn_mm);
  carriage_->setName("carriage");
  carriage_->attachSlider(nullptr, Vector::UnitX());
  muscle_ = new Muscle(world, space(), start_mm_, start_mm_ + (end - start_mm_) / 3, start_mm_ + (end - start_mm_) * 2 / 3, end, minimum_mm,
                       maximum_mm);
  muscle_->setForceLaw(makeForceLaw(world.parameters(), minimum_mm, rest_mm));
  spring_ =
      new Spring(world, space(), end, anchor_mm_, 2 * maximum_mm, [this](double length_mm) { return springN(anchor_mm_.x() - length_mm); });
  muscle_->connectStartTo(nullptr);
  muscle_->connectEndTo(carriage_);
  spring_->connectStartTo(carriage_);
  spring_->connectEndTo(nullptr);
  addActuator(muscle_);
  setLoad(carriage_);
}

double SpringBench::springN(double length_mm) const {
  return std::max(0.0, load_N_ + spring_N_per_mm_ * (reference_mm_ - length_mm));
}

void SpringBench::placeCarriage(double length_mm) {
  const double y = start_mm_.y();
  carriage_->place({std::sqrt(length_mm * length_mm - y * y), 0, 0}, Eigen::Matrix3d::Identity());
}

void SpringBench::settle() {
  RobotEffects& effects = world().effects();
  const auto stops = muscle_->straightLengthRange();
  auto surplus = [&](double length_mm) {
    placeCarriage(length_mm);
    const double x = carriage_->getPosition().x();
    return effects.restingTensionN(0, length_mm) * x / length_mm - springN(x) - effects.restingLoad(*carriage_).force_N.x();
  };
  placeCarriage(rootBetween(surplus, stops.shortest_mm, stops.longest_mm));
  const Vector end = carriage_->getPosition();
  muscle_->placeStraight(start_mm_, end);
  spring_->placeStraight(end, anchor_mm_);
}

}  // namespace musclesim
