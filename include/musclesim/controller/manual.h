/// Manual control: a user sets the pressures.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "musclesim/controller/controller.h"

namespace musclesim {

/// Wraps another controller and passes its pressures on until a user takes over; from then on it commands the pressures that the user sets.
///
/// During manual control the other controller is not called; handBack() lets it continue from its old state. Taking over changes no
/// pressure. Until a user takes over, the run is the same to the bit as without this class. The user may act from another thread.
class ManualController final : public Controller {
 public:
  /// Throws BadParameter if `automatic` is null or there are no muscles.
  ManualController(std::unique_ptr<Controller> automatic, int muscle_count);

  Action output(const State& state) override;
  std::optional<double> activity() const override { return automatic_->activity(); }
  std::optional<Vector> targetMm() const override { return automatic_->targetMm(); }
  bool targetIsHeight() const override { return automatic_->targetIsHeight(); }
  std::vector<std::pair<std::string, double>> signals() const override { return automatic_->signals(); }
  std::optional<double> endS() const override { return automatic_->endS(); }
  std::vector<std::string> notes() const override { return automatic_->notes(); }

  void takeOver();
  void handBack();
  bool isManual() const;
  /// Takes over and sets one pressure, clamped to 0..1. Throws BadParameter for a muscle that does not exist.
  void set(int muscle, double pressure_ratio);
  /// Takes over and vents all muscles.
  void reset();
  /// The pressures that are commanded now, by the user or by the controller.
  Action pressures() const;

  /// An interval of manual control, s. The last interval ends at the latest call of output().
  struct Interval {
    double from_s, to_s;
  };
  std::vector<Interval> manualIntervals() const;

 private:
  void note(const State& state);

  std::unique_ptr<Controller> automatic_;
  mutable std::mutex access_;
  bool manual_ = false, was_manual_ = false;
  Action pressures_;
  std::vector<Interval> intervals_;
};

}  // namespace musclesim
