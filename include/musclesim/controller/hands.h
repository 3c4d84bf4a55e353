/// What a user does to a run from outside.
#pragma once

#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "musclesim/robot/pull.h"
#include "musclesim/robot/state.h"

namespace musclesim {

/// What acts on a run during one control step, besides its controller.
struct UserInput {
  bool by_hand = false;                  ///< the user sets the pressures
  Action pressures = {};                 ///< by hand: those; else empty
  std::optional<Vector> target_mm = {};  ///< where the user has moved the target
  std::optional<Pull> pull = {};         ///< the user pulls at a body
  bool operator==(const UserInput&) const = default;
};

/// All inputs of a run up to a moment. Together with what the run was built from they determine its state: repeating them brings it back.
struct InputHistory {
  std::vector<std::pair<long, UserInput>> changes = {};  ///< number of a control step, and the input from then on; before: none
  long step_count = 0;                                   ///< control steps that have had their input
  double time_s = 0;                                     ///< of the last one

  UserInput at(long step) const;
};

/// The user's hands: set in any thread, sampled by the run's thread once per control step.
class Hands {
 public:
  /// `repeated`: inputs of an earlier run. They come first, and what the user does meanwhile has no effect. Throws BadParameter without
  /// muscles.
  explicit Hands(int muscle_count, InputHistory repeated = {});

  void takeOver();
  void handBack();
  bool isManual() const;
  /// Takes over and sets one pressure, clamped to 0..1. Throws BadParameter for a muscle that does not exist.
  void set(int muscle, double pressure_ratio);
  /// Takes over and vents all muscles.
  void reset();
  /// The pressures that are commanded now, by the user or by the controller.
  Action pressures() const;
  void moveTarget(const Vector& target_mm);
  /// Where the user has moved the target; none: it is where the controller has it.
  std::optional<Vector> movedTargetMm() const;
  /// Holds a body; none: lets go.
  void pull(const std::optional<Pull>& pull);

  /// The input of the next control step, which is at this time.
  UserInput sample(double time_s);
  /// Tells the pressures of the controller, which the user takes over.
  void note(const Action& commanded);

  InputHistory history() const;
  bool isRepeating() const;
  double repeatedUntilS() const { return repeated_.time_s; }

 private:
  const InputHistory repeated_;
  mutable std::mutex access_;
  UserInput now_;
  InputHistory history_;
};

}  // namespace musclesim
