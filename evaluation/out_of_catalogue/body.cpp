/// Out-of-catalogue laws of the body stage: LuGre friction with a Stribeck curve (Canudas de Wit et al. 1995) of joints and slides, damping
/// that grows with speed, a hardening spring, a payload with air drag, a swaying base, attachments shifted in an oblique direction, rubber
/// stops, a force from a weak spring, contact after Hunt and Crossley (1975).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../effect/body/attachment_offset.h"
#include "laws_by_stage.h"
#include "musclesim/base/units.h"
#include "musclesim/robot/robot.h"
#include "musclesim/robot/world.h"

namespace musclesim::out_of_catalogue {

namespace {

/// LuGre friction: F = s_0 z + s_1 dz/dt,  dz/dt = v - s_0 |v| z / g(v),  g = F_c (1 + 0.3 exp(-(v / v_s)^2)),  s_0 = F_c / presliding,
/// s_1 = 5 ms s_0
struct Bristle {
  double full, presliding, stribeck_speed;  ///< N and mm, or N m and rad
  double bend = 0;                          ///< z

  /// The friction against a speed that is kept for h_s.
  double friction(double speed, double h_s) {
    constexpr double excess = 0.3, damping_s = 5e-3;
    const double x = speed / stribeck_speed, largest = full * (1 + excess * std::exp(-x * x)), stiffness = full / presliding;
    const double decay = stiffness * std::abs(speed) / largest;
    const double next = (bend + h_s * speed) / (1 + h_s * decay);
    const double rate = (next - bend) / h_s;
    bend = next;
    return stiffness * (bend + damping_s * rate);
  }
};

class LuGre final : public JointEffect {
 public:
  explicit LuGre(const EffectValues& v) : bristle_{v["torque_Nm"], 0.004, 0.3} {}
  void reset() override { bristle_.bend = 0; }
  void apply(const StepTime& time) override {
    if (time.h_s > 0) addTorqueNm(-bristle_.friction(rateRadPerS(), time.h_s));  // friction does not shift an equilibrium
  }

 private:
  Bristle bristle_;
};

class LuGreSlide final : public SlideEffect {
 public:
  explicit LuGreSlide(const EffectValues& v) : bristle_{v["force_N"], 0.1, 20} {}
  void reset() override { bristle_.bend = 0; }
  void apply(const StepTime& time) override {
    if (time.h_s > 0) addForceN(-bristle_.friction(rateMmPerS(), time.h_s));
  }

 private:
  Bristle bristle_;
};

/// torque = -b w (1 + |w| / 3 rad/s)
class GrowingDamping final : public JointEffect {
 public:
  explicit GrowingDamping(const EffectValues& v) : damping_(v["damping_Nms_per_rad"]) {}
  void apply(const StepTime&) override {
    constexpr double doubling_rad_per_s = 3;
    const double w = rateRadPerS();
    addTorqueNm(-damping_ * w * (1 + std::abs(w) / doubling_rad_per_s));
  }

 private:
  double damping_;
};

/// torque = -k (x + x^3 / (1 rad)^2),  x = q - q_0
class HardeningSpring final : public JointEffect {
 public:
  explicit HardeningSpring(const EffectValues& v) : stiffness_(v["stiffness_Nm_per_rad"]), rest_deg_(v["rest_deg"]) {}
  void apply(const StepTime&) override {
    constexpr double doubling_rad = 1;
    const double x = (angleDeg() - rest_deg_) * rad_per_deg;
    addTorqueNm(-stiffness_ * x * (1 + x * x / (doubling_rad * doubling_rad)));
  }

 private:
  double stiffness_, rest_deg_;
};

/// A point mass with drag -c m |v| v.
class DraggedPayload final : public HandEffect {
 public:
  explicit DraggedPayload(const EffectValues& v) : mass_kg_(v["mass_kg"]), drag_Ns2_per_m2_(v["drag_per_m"] * std::abs(mass_kg_)) {}
  void attach(const EffectPlace& place) override {
    HandEffect::attach(place);
    place.robot.loadHand(mass_kg_ * g_per_kg);
  }
  void apply(const StepTime&) override {
    dVector3 velocity;
    const Vector point = pointMm();
    dBodyGetPointVel(robot().hand()->body().id, point.x(), point.y(), point.z(), velocity);
    const Vector v = Vector(velocity[0], velocity[1], velocity[2]) / mm_per_m;
    addForceN(-drag_Ns2_per_m2_ * v.norm() * v);
  }

 private:
  double mass_kg_, drag_Ns2_per_m2_;
};

/// Gravity rotated by tilt (1 + a sin(2 pi f t)).
class SwayingBase final : public BodyEffect {
 public:
  explicit SwayingBase(const EffectValues& v)
      : tilt_x_deg_(v["tilt_x_deg"]), tilt_z_deg_(v["tilt_z_deg"]), sway_(v["sway"]), frequency_Hz_(v["frequency_Hz"]) {}
  void attach(const EffectPlace& place) override {
    world_ = place.world;
    upright_ = place.world.gravityMmPerS2();
    turn(0);
  }
  void apply(const StepTime& time) override { turn(std::max(0.0, time.clock_s)); }

 private:
  void turn(double t) const {
    const double share = (1 + sway_ * std::sin(2 * std::numbers::pi * frequency_Hz_ * t)) * rad_per_deg;
    const Vector g =
        Eigen::AngleAxisd(share * tilt_z_deg_, Vector::UnitZ()) * (Eigen::AngleAxisd(share * tilt_x_deg_, Vector::UnitX()) * upright_);
    dWorldSetGravity(world_, g.x(), g.y(), g.z());
  }
  double tilt_x_deg_, tilt_z_deg_, sway_, frequency_Hz_;
  dWorldID world_ = nullptr;
  Vector upright_;
};

/// Rubber in front of both stops: torque = -t exp((q - high) / 2 deg) + t exp((low - q) / 2 deg), stops shifted by d.
class RubberStops final : public JointEffect {
 public:
  explicit RubberStops(const EffectValues& v) : offset_deg_(v["offset_deg"]) {}
  void attach(const EffectPlace& place) override {
    JointEffect::attach(place);
    low_deg_ = dJointGetHingeParam(joint().id(), dParamLoStop) * deg_per_rad + offset_deg_;
    high_deg_ = dJointGetHingeParam(joint().id(), dParamHiStop) * deg_per_rad + offset_deg_;
  }
  void apply(const StepTime&) override {
    constexpr double torque_Nm = 1.5, depth_deg = 2, furthest = 4;
    auto push = [&](double beyond_deg) { return torque_Nm * std::exp(std::min(beyond_deg / depth_deg, furthest)); };
    addTorqueNm(push(low_deg_ - angleDeg()) - push(angleDeg() - high_deg_));
  }

 private:
  double offset_deg_, low_deg_ = 0, high_deg_ = 0;
};

/// F = F_0 (1 - d / L), d displacement of the hand along F_0
class WeakSpring final : public HandEffect {
 public:
  explicit WeakSpring(const EffectValues& v) : force_N_(v["force_x_N"], v["force_y_N"], v["force_z_N"]), stretch_mm_(v["stretch_mm"]) {}
  void attach(const EffectPlace& place) override {
    HandEffect::attach(place);
    built_mm_ = pointMm();
  }
  void apply(const StepTime&) override { addForceN(force_N_ * (1 - force_N_.normalized().dot(pointMm() - built_mm_) / stretch_mm_)); }

 private:
  Vector force_N_, built_mm_;
  double stretch_mm_;
};

/// torque = -k x^1.5 (1 + c dx/dt),  x depth beyond the plane in deg
class HuntCrossley final : public JointEffect {
 public:
  explicit HuntCrossley(const EffectValues& v) : stiffness_(v["stiffness_Nm_per_deg15"]), plane_deg_(v["plane_deg"]) {}
  void apply(const StepTime&) override {
    constexpr double loss_s_per_deg = 1e-3;
    const double side = plane_deg_ >= 0 ? 1 : -1;
    const double depth = side * (angleDeg() - plane_deg_);
    if (depth <= 0) return;
    const double approach = side * rateRadPerS() * deg_per_rad;
    addTorqueNm(-side * stiffness_ * std::pow(depth, 1.5) * std::max(0.0, 1 + loss_s_per_deg * approach));
  }

 private:
  double stiffness_, plane_deg_;
};

/// One end is shifted in a direction between the lever arm and the muscle's line, as a misplaced bracket would shift it. If both distances
/// of the catalogue's attachment_offset are fitted, the laws are the same.
EffectInfo turnedAttachment(const std::string& id, MuscleEnd displaced) {
  EffectInfo info = entry(id, Stage::body, {ComponentKind::muscle}, "place' = place + d (e cos a + up sin a)",
                          {{"offset_mm", "mm", 0, -200, 200, -8, 8, "d"}, {"turn_deg", "deg", 4, -90, 90, -25, 25, "a", true}},
                          [displaced](const EffectValues&) { return std::make_unique<AttachmentOffset>(displaced); });
  info.mount_offset_mm = [displaced](const EffectValues& values, MuscleEnd end) -> Eigen::Vector2d {
    if (end != displaced) return {0, 0};
    const double turn_rad = values["turn_deg"] * rad_per_deg;
    return values["offset_mm"] * Eigen::Vector2d(std::cos(turn_rad), std::sin(turn_rad));
  };
  return info;
}

}  // namespace

std::vector<OutOfCatalogueLaw> bodyLaws() {
  const std::vector<ComponentKind> joint = {ComponentKind::joint}, hand = {ComponentKind::hand};
  return {
      {entry("lugre", Stage::body, joint, "LuGre friction with Stribeck excess of 0.3",
             {{"torque_Nm", "N m", 0, 0, 100, 0.05, 0.6, "sliding"}}, [](const EffectValues& v) { return std::make_unique<LuGre>(v); }),
       "joint_coulomb_friction"},
      {entry("lugre_slide", Stage::body, {ComponentKind::slide}, "LuGre friction of a slide with Stribeck excess of 0.3",
             {{"force_N", "N", 0, 0, 1e4, 1, 10, "sliding"}}, [](const EffectValues& v) { return std::make_unique<LuGreSlide>(v); }),
       "slide_friction"},
      {entry("growing_damping", Stage::body, joint, "torque = -b w (1 + |w| / 3 rad/s)",
             {{"damping_Nms_per_rad", "N m s/rad", 0, 0, 10, 0.01, 0.3, "b"}},
             [](const EffectValues& v) { return std::make_unique<GrowingDamping>(v); }),
       "joint_viscous_friction"},
      {entry("hardening_spring", Stage::body, joint, "torque = -k (x + x^3 / (1 rad)^2)",
             {{"stiffness_Nm_per_rad", "N m/rad", 0, 0, 1e3, 0.1, 1.5, "k"}, {"rest_deg", "deg", 0, -180, 180, -20, 20, "of x = 0", true}},
             [](const EffectValues& v) { return std::make_unique<HardeningSpring>(v); }),
       "joint_stiffness"},
      {entry("dragged_payload", Stage::body, hand, "point mass with drag -c m |v| v",
             {{"mass_kg", "kg", 0, -1e3, 1e3, 0.05, 0.6, "mass"}, {"drag_per_m", "1/m", 0.3, 0, 1e3, 0.1, 0.6, "c", true}},
             [](const EffectValues& v) { return std::make_unique<DraggedPayload>(v); }),
       "payload"},
      {entry("swaying_base", Stage::body, {ComponentKind::base}, "tilt (1 + a sin(2 pi f t))",
             {{"tilt_x_deg", "deg", 0, -180, 180, -8, 8, "about x"},
              {"tilt_z_deg", "deg", 0, -180, 180, -8, 8, "about z"},
              {"sway", "", 0.1, 0, 10, 0.02, 0.2, "a", true},
              {"frequency_Hz", "Hz", 1.7, 0, 100, 0.5, 4, "f", true}},
             [](const EffectValues& v) { return std::make_unique<SwayingBase>(v); }),
       "base_tilt"},
      {turnedAttachment("turned_attachment", MuscleEnd::start), "attachment_offset"},
      {turnedAttachment("turned_end", MuscleEnd::end), "attachment_offset"},
      {entry("rubber_stops", Stage::body, joint, "exponential bumpers at shifted stops",
             {{"offset_deg", "deg", 0, -90, 90, -60, 60, "shift"}}, [](const EffectValues& v) { return std::make_unique<RubberStops>(v); }),
       "joint_stop_offset"},
      {entry("weak_spring", Stage::body, hand, "F = F_0 (1 - d / L), d the way of the hand along F_0",
             {{"force_x_N", "N", 0, -1e4, 1e4, -8, 8, "F_0"},
              {"force_y_N", "N", 0, -1e4, 1e4, -8, 8, "F_0"},
              {"force_z_N", "N", 0, -1e4, 1e4, 0, 0, "F_0"},
              {"stretch_mm", "mm", 1000, 1, 1e6, 500, 2000, "L", true}},
             [](const EffectValues& v) { return std::make_unique<WeakSpring>(v); }),
       "external_force"},
      {entry("hunt_crossley", Stage::body, joint, "torque = -k x^1.5 (1 + c dx/dt)",
             {{"stiffness_Nm_per_deg15", "N m/deg^1.5", 0, 0, 100, 0.05, 0.5, "k"},
              {"plane_deg", "deg", 10, -180, 180, -20, 20, "plane", true}},
             [](const EffectValues& v) { return std::make_unique<HuntCrossley>(v); }),
       "contact"},
  };
}

}  // namespace musclesim::out_of_catalogue
