/// The robot in MuJoCo.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <map>

#include "engine.h"
#include "mjcf.h"
#include "muscle_forces.h"
#include "musclesim/base/error.h"

namespace musclesim::peers {

namespace {

struct Delete {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
  void operator()(mjVFS* v) const {
    mj_deleteVFS(v);
    delete v;
  }
};

[[noreturn]] void throwError(const char* message) {
  throw Error(std::string("MuJoCo: ") + message);
}
void ignoreWarning(const char*) {}

std::unique_ptr<mjModel, Delete> compile(const std::string& mjcf) {
  const std::unique_ptr<mjVFS, Delete> files(new mjVFS);
  mj_defaultVFS(files.get());
  constexpr const char* name = "robot.xml";
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), name)], mjcf.data(), mjcf.size());
  char error[1000] = "";
  std::unique_ptr<mjModel, Delete> model(mj_loadXML(name, files.get(), error, sizeof error));
  if (!model) throw Error(std::string("MuJoCo refuses the model: ") + error);
  return model;
}

Vector vectorAt(const mjtNum* v) {
  return Vector(v[0], v[1], v[2]);
}

class MujocoPeer final : public Peer {
 public:
  MujocoPeer(const Mechanism& mechanism, const Tree& tree, const MjcfOptions& options, bool adds_inertia)
      : mechanism_(mechanism),
        tree_(tree),
        adds_inertia_(adds_inertia),
        model_(compile(mjcfOf(mechanism, tree, options))),
        data_(mj_makeData(model_.get())) {
    for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
      body_ids_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, fmt::format("b{}", i).c_str()));
    for (std::size_t m = 0; m < mechanism.muscles.size(); ++m) {
      const MuscleParts& parts = mechanism.muscles[m];
      Muscle muscle{.actuator = parts.actuator, .length_m = parts.length_m};
      for (const int slider : parts.sliders) muscle.sliders.push_back(model_->jnt_qposadr[joint(slider)]);
      for (const int slider : parts.sliders) muscle.slider_dofs.push_back(model_->jnt_dofadr[joint(slider)]);
      for (const int slider : parts.sliders) addBeads(muscle, mechanism.joints[static_cast<std::size_t>(slider)]);
      for (const int hinge : parts.hinges) muscle.hinges.push_back(hingeStops(hinge));
      if (!parts.points.empty()) muscle.line = mj_name2id(model_.get(), mjOBJ_TENDON, fmt::format("m{}", m).c_str());
      muscles_.push_back(std::move(muscle));
    }
    forward();
    // A line's length counts from the pose in which it was read: musclesim's is that of the path without the tendon.
    for (Muscle& muscle : muscles_)
      if (muscle.line >= 0) muscle.length_m -= data_->ten_length[muscle.line];
  }

  void advance(const Action& pressure_ratio, int step_count) override {
    pressure_ratio_ = pressure_ratio;
    const Control control(*this);
    for (int i = 0; i < step_count; ++i) {
      moveStops();
      if (adds_inertia_) addInertia();
      mj_step(model_.get(), data_.get());
    }
    for (const int warning : {mjWARN_INERTIA, mjWARN_CNSTRFULL, mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
      if (data_->warning[warning].number > 0) throw Error(fmt::format("MuJoCo: warning {} at {} s", warning, data_->time));
  }

  Vector handM() const override {
    forward();
    return place(mechanism_.hand.body, mechanism_.hand.place_m);
  }

  double gapM() const override {
    forward();
    double worst = 0;
    for (const int loop : tree_.loops) {
      const BodyJoint& joint = mechanism_.joints[static_cast<std::size_t>(loop)];
      worst = std::max(worst, (anchorOn(joint.first, joint) - anchorOn(joint.second, joint)).norm());
    }
    return worst;
  }

  double coordinate(int index) const override {
    return data_->qpos[model_->jnt_qposadr[joint(index)]] - model_->qpos0[model_->jnt_qposadr[joint(index)]];
  }

  double energyJ() const override {
    forward();
    mj_energyPos(model_.get(), data_.get());
    mj_energyVel(model_.get(), data_.get());
    return data_->energy[0] + data_->energy[1];
  }

 private:
  struct HingeStops {
    mjtNum* range;
    double at;  ///< coordinate as built of the pose in which the mechanism was read
  };
  struct Muscle {
    const Actuator* actuator;
    double length_m;  ///< at coordinates of 0; of a line: without its tendon's length
    std::vector<int> sliders = {}, slider_dofs = {};
    std::vector<HingeStops> hinges = {};
    std::vector<int> beads = {};
    double bead_inertia_kg_m2 = 0;
    int line = -1;
  };

  int joint(int index) const { return mj_name2id(model_.get(), mjOBJ_JOINT, fmt::format("j{}", index).c_str()); }
  HingeStops hingeStops(int index) {
    return {model_->jnt_range + 2 * joint(index), mechanism_.joints[static_cast<std::size_t>(index)].coordinate_as_built};
  }

  void forward() const {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_tendon(model_.get(), data_.get());
  }

  double lengthM(const Muscle& muscle) const {
    double length_m = muscle.length_m;
    for (const int slider : muscle.sliders) length_m -= data_->qpos[slider];
    return length_m;
  }

  /// The stops of the hinges between links depend on the chain's length.
  void moveStops() {
    for (const Muscle& muscle : muscles_) {
      if (muscle.hinges.empty()) continue;
      const double stop = hingeStopRad(*muscle.actuator, lengthM(muscle));
      for (const HingeStops& hinge : muscle.hinges) {
        hinge.range[0] = -stop - hinge.at;
        hinge.range[1] = stop - hinge.at;
      }
    }
  }

  void addBeads(Muscle& muscle, const BodyJoint& slider) const {
    for (const int body : {slider.first, slider.second}) muscle.beads.push_back(body_ids_[static_cast<std::size_t>(body)]);
    muscle.bead_inertia_kg_m2 = mechanism_.bodies[static_cast<std::size_t>(slider.first)].inertia_kg_m2(0, 0);
  }

  /// What beads gain from tension in musclesim (docs/developer/stepper.md, section 8): a h^2 F l / (2 n), a = 1/4. It lets a step be
  /// longer.
  void addInertia() {
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
      const Muscle& muscle = muscles_[m];
      const double length_m = lengthM(muscle), h_s = model_->opt.timestep;
      const double tension_N = tensionN(*muscle.actuator, pressure_ratio_[m], length_m);
      const double inertia = muscle.bead_inertia_kg_m2 + 0.25 * h_s * h_s * tension_N * length_m / static_cast<double>(muscle.beads.size());
      for (const int bead : muscle.beads) std::fill_n(model_->body_inertia + 3 * bead, 3, inertia);
    }
  }

  void pull() {
    int motor = 0;
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
      const Muscle& muscle = muscles_[m];
      if (muscle.line >= 0) {
        data_->ctrl[motor++] = -lineForceN(*muscle.actuator, pressure_ratio_[m], muscle.length_m + data_->ten_length[muscle.line],
                                           data_->ten_velocity[muscle.line]);
        continue;
      }
      const double tension_N = tensionN(*muscle.actuator, pressure_ratio_[m], lengthM(muscle));
      for (const int dof : muscle.slider_dofs) data_->qfrc_applied[dof] = tension_N;
    }
  }

  Vector place(int body, const Vector& point_m) const {
    if (body == environment) return point_m;
    const int id = body_ids_[static_cast<std::size_t>(body)];
    return vectorAt(data_->xpos + 3 * id) + Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * id) * point_m;
  }
  Vector anchorOn(int body, const BodyJoint& joint) const {
    if (body == environment) return joint.anchor_m;
    const RigidBody& as_read = mechanism_.bodies[static_cast<std::size_t>(body)];
    return place(body, as_read.rotation.conjugate() * (joint.anchor_m - as_read.position_m));
  }

  /// MuJoCo asks for the muscles' forces as long as this exists.
  struct Control {
    explicit Control(MujocoPeer& peer) {
      running_ = &peer;
      mjcb_control = [](const mjModel*, mjData*) { running_->pull(); };
    }
    ~Control() { mjcb_control = nullptr; }
    Control(const Control&) = delete;
    Control& operator=(const Control&) = delete;
  };
  static thread_local MujocoPeer* running_;
  const Mechanism& mechanism_;
  const Tree& tree_;
  bool adds_inertia_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::vector<int> body_ids_;
  std::vector<Muscle> muscles_;
  Action pressure_ratio_;
};

thread_local MujocoPeer* MujocoPeer::running_ = nullptr;

/// A method is "INTEGRATOR, SOLVER" and may go on: "added inertia" gives beads the inertia that musclesim gives them, "hard stops"
/// MjcfOptions.
std::unique_ptr<Peer> make(const Mechanism& mechanism, const Tree& tree, const PeerSettings& settings) {
  mju_user_error = throwError;
  mju_user_warning = ignoreWarning;
  const std::string& method = settings.method;
  const std::size_t comma = method.find(", "), end = method.find(", ", comma + 2);
  const std::string further = end == std::string::npos ? "" : method.substr(end + 2);
  const MjcfOptions options{.step_s = settings.step_s,
                            .integrator = method.substr(0, comma),
                            .solver = method.substr(comma + 2, end - comma - 2),
                            .hard_stops = further == "hard stops"};
  return std::make_unique<MujocoPeer>(mechanism, tree, options, further == "added inertia");
}

}  // namespace

}  // namespace musclesim::peers

extern "C" const musclesim::peers::PeerEngine* musclesim_peer_mujoco() {
  static const musclesim::peers::PeerEngine engine{
      "MuJoCo",
      mj_versionString(),
      {"Euler, Newton", "Euler, Newton, added inertia", "Euler, CG", "Euler, PGS", "implicit, Newton", "RK4, Newton"},
      musclesim::peers::make};
  return &engine;
}
