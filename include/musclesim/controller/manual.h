/// Pressures set by hand.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "musclesim/controller/controller.h"

namespace musclesim {

/// Stands in front of another controller and passes its pressures on, until a hand takes over; then it commands what the hand sets.
///
/// The other controller is not asked meanwhile, and goes on where it was when it is handed back. Taking over changes no pressure. While no
/// hand has taken over, the run has the bits that it has without this class. Hands may be in another thread than the run.
class ManualController final : public Controller {
 public:
  /// Throws BadParameter for null or no muscles.
  ManualController(std::unique_ptr<Controller> automatic, int muscle_count);

  Action output(const State& state) override;
  std::optional<double> activity() const override { return automatic_->activity(); }
  std::optional<Vector> targetMm() const override { return automatic_->targetMm(); }
  bool targetIsHeight() const override { return automatic_->targetIsHeight(); }

  void takeOver();
  void handBack();
  bool isManual() const;
  /// Takes over and sets one pressure, clamped to 0..1. Throws BadParameter for a muscle that does not exist.
  void set(int muscle, double pressure_ratio);
  /// Takes over and vents all muscles.
  void reset();
  /// What is commanded at present, by whomever.
  Action pressures() const;

  /// From when to when a hand commanded, s; the last end is that of the latest output.
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
