/// Manual control: a user sets the pressures.
#pragma once

#include <memory>
#include <vector>

#include "musclesim/controller/controller.h"
#include "musclesim/controller/hands.h"

namespace musclesim {

/// Wraps another controller and passes its pressures on until a user takes over; from then on it commands the pressures that the user sets.
///
/// During manual control the other controller is not called; handing back lets it continue from its old state. Taking over changes no
/// pressure. Until a user takes over, the run is the same to the bit as without this class. The user acts through hands().
class ManualController final : public Controller {
 public:
  /// `repeated`: see Hands. Throws BadParameter if `automatic` is null or there are no muscles.
  ManualController(std::unique_ptr<Controller> automatic, int muscle_count, InputHistory repeated = {});

  Action output(const State& state) override;
  std::optional<double> activity() const override { return automatic_->activity(); }
  std::optional<Vector> targetMm() const override { return automatic_->targetMm(); }
  bool targetIsHeight() const override { return automatic_->targetIsHeight(); }
  void moveTarget(const Vector& target_mm) override { automatic_->moveTarget(target_mm); }
  std::vector<std::pair<std::string, double>> signals() const override { return automatic_->signals(); }
  std::optional<double> endS() const override { return automatic_->endS(); }
  std::vector<std::string> notes() const override { return automatic_->notes(); }

  /// They may outlive the controller.
  const std::shared_ptr<Hands>& hands() const { return hands_; }
  /// What acts since the latest call of output().
  const UserInput& input() const { return input_; }

  /// An interval of manual control, s. The last interval ends at the latest call of output().
  struct Interval {
    double from_s, to_s;
  };
  const std::vector<Interval>& manualIntervals() const { return intervals_; }

 private:
  std::unique_ptr<Controller> automatic_;
  std::shared_ptr<Hands> hands_;
  UserInput input_;
  std::vector<Interval> intervals_;
};

}  // namespace musclesim
