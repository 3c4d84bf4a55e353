/// Position control: joint angles or the height of the hand follow a target.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/controller/channels.h"
#include "musclesim/controller/controller.h"
#include "musclesim/controller/task.h"

namespace musclesim {

class InverseModel;
struct Antagonism;

/// Antagonists under co-contraction and difference, with a loop per controlled quantity:
///     p_i = level_i + sum over loops of c_i u,   limited to 0..1
///     u   = u_ff + K_p e + I + K_d de/dt,        limited to |u| <= u_max;   e = r - y
///     dI/dt = K_i e + (u_limited - u) K_i / K_p                              (anti-windup by back-calculation)
/// p_i command of muscle i and its co-contraction level_i, fractions of full scale; c_i 1 for muscles that rise and -1 for those that fall;
/// u difference of pressure; y reading of an angle in degrees or of the hand's height in mm, as sensors and their effects show it; r its
/// target; u_max the largest distance of a level from the ends of 0..1. K_p, K_i and K_d are position.proportional_<joint>_per_deg,
/// position.integral_<joint>_per_deg_s and position.damping_<joint>_s_per_deg, or without joint and with mm. By default K_p b = w^2,
/// K_d b = 2 d w and K_i = 1.7/s K_p, with b the model's acceleration per difference at the first target, w = 36/s and d = 1.5. de/dt is
/// the difference of two errors over the control step. At the first call, when the robot has not moved yet, u is u_ff alone.
///
/// Feed-forward u_ff of angles: the difference that gives the clean model the target's acceleration at the target (InverseModel): the
/// inverse of force law, moment arms, weights and inertia, without friction and effects. It is taken half a control step ahead, in the
/// middle of the time for which the command holds. The acceleration is the second difference of the target over 0.05 s to either side; at
/// the first call, under whose command robots settle, it is 0. Robots whose joints close a loop have no feed-forward, and
/// position.feed_forward turns it off.
/// Sources: Åström & Hägglund, PID Controllers, 2nd edition, Ch. 3 (anti-windup); pressures as co-contraction and difference are usual for
/// antagonists.
///
/// position.quantity chooses angles (a loop for every joint with a channel; targets position.target_<joint>_deg, the middle of the joint's
/// range by default, plus a sine of position.amplitude_<joint>_deg with position.period_s) or height (one loop of all channels; the target
/// of the height task). A targets file of the request replaces them: columns time_s and angle_<joint>_deg or target_<joint>_deg, hand_y_mm
/// or target_y_mm, with straight lines in between. Channels are the request's or the robot's antagonists (antagonistsOf).
class PositionController final : public Controller {
 public:
  /// Throws BadParameter without a robot, without antagonists, for a channel whose joint is not known, for a target beyond the stops of
  /// its joint (from a file: a note), and as Target::make. Throws BadFile for a targets file that lacks a target.
  explicit PositionController(const ControllerRequest& request);
  ~PositionController() override;
  Action output(const State& state) override;
  std::optional<Vector> targetMm() const override;
  bool targetIsHeight() const override { return is_height_; }
  /// The height then stays there, whatever a targets file says.
  void moveTarget(const Vector& target_mm) override;
  std::vector<std::pair<std::string, double>> signals() const override;
  std::optional<double> endS() const override { return end_s_; }
  std::vector<std::string> notes() const override;

 private:
  struct Gains {
    double proportional = 0, integral_per_s = 0, damping_s = 0;
  };
  struct Loop {
    std::string joint;              ///< empty: the hand's height
    std::size_t angle = 0;          ///< place among the robot's angles
    std::vector<Channel> channels;  ///< all driven by one u
    std::vector<double> sense;      ///< c_i
    std::function<double(double)> target;
    Gains gains;
    double integrated = 0;  ///< I
    double target_now = 0, error_before = 0;
  };
  void addLoops(const ControllerRequest& request, const std::vector<Channel>& channels);
  void setTargets(const ControllerRequest& request);
  void noteTargetsBeyondStops(const Loop& loop, const std::vector<double>& targets_deg, const Robot& robot);
  void setGains(Parameters& parameters);
  Gains usualGains(const Loop& loop) const;
  Antagonism antagonism(const Loop& loop) const;
  std::vector<double> anglesAt(double time_s) const;  ///< targets
  void invertModel(const Robot& robot);
  double reading(const Loop& loop, const State& state) const;
  double forward(const Loop& loop, double time_s) const;
  double difference(Loop& loop, const State& state);

  std::vector<Loop> loops_;
  std::vector<double> level_;
  std::unique_ptr<InverseModel> inverse_;  ///< null: there is no model of the robot
  double step_s_, largest_difference_ = 0;
  std::size_t angle_count_ = 0;
  bool is_height_ = false, feeds_forward_ = false, has_begun_ = false, has_error_ = false;
  std::optional<double> end_s_;
  std::string feed_forward_note_;
  std::vector<std::string> target_notes_;
};

}  // namespace musclesim
