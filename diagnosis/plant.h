/// The recordings of one plant and the model that is compared with them.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "musclesim/base/units.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/simulation/replay.h"
#include "noise_sigma.h"
#include "prediction_store.h"

namespace musclesim {

/// One signal that both the recordings and the model have.
struct ComparedSignal {
  std::string name;
  NoiseSigma sigma;
};

inline constexpr int fewest_compared_rows = 10;  ///< a signal with fewer numbers in a stretch is not compared there

/// A stretch of one recording. Simulations always begin at the recording's first row; only rows of the stretch are compared, or every n-th
/// of them.
struct Segment {
  int recording = 0;
  int first_row = 0, end_row = 0;
  int every = 1;
};

/// Which stretches parameters are fitted to and explanations are chosen on, and which only measure the result.
struct Split {
  std::vector<Segment> fit, held_out;
  std::string held_out_words;
};

/// How finely a simulation steps: each takes steps twice as long as the one before, which costs less. What it differs by is nearly the same
/// for all models of one plant, so that differences between coarse predictions hold (Comparison corrects for the rest).
enum class Fidelity { fine, medium, coarse, coarsest };

/// A model: further effects and changed parameters beside the user's own.
struct Model {
  std::vector<ActiveEffect> effects;
  std::vector<std::pair<std::string, double>> parameters;
};

class Plant {
 public:
  /// Throws as diagnose().
  Plant(std::vector<Recording> recordings, const DiagnosisOptions& options);

  const std::vector<Recording>& recordings() const { return recordings_; }
  const std::vector<ComparedSignal>& signals() const { return signals_; }
  /// What is odd about the recordings and what was done about it.
  const std::vector<std::string>& notes() const { return notes_; }
  const Split& split() const { return split_; }
  /// Stretches that a first look is content with: of up to three recordings with different commands, from the beginning to 4 s after the
  /// commands first change (12 s of one recording, 6 s of two) and 400 rows after that at least (1200, 600); of rows that follow more
  /// closely than 100 per second only as many.
  std::vector<Segment> screeningSegments() const;
  const std::string& robot() const { return recordings_.front().info.robot; }
  int muscleCount() const { return recordings_.front().muscleCount(); }
  /// Whether the model holds effects of a stage beforehand, by options or by a sidecar.
  bool holds(Stage stage) const;
  /// The measured values of a compared signal; empty if this recording does not have it.
  const std::vector<double>& measured(int recording, int signal) const;
  /// All components of the robot on which an effect can act.
  std::vector<std::string> componentsFor(const EffectInfo& info) const;
  /// Whether a component "signal_<stem>" (or "all") names something that is compared.
  bool compares(const std::string& signal_component) const;
  static bool isComponentOf(const std::string& component, const std::string& signal_name);
  /// Shortest and longest length of a muscle.
  struct MuscleRange {
    double minimum_mm, maximum_mm;
  };
  MuscleRange muscleRange(int muscle) const;
  /// Numbers of the model itself that no effect of the catalogue stands for, with the values in force: what the nominal refit re-tunes.
  const std::vector<std::pair<std::string, double>>& nominalParameters() const { return nominal_; }
  /// The numbers of the model that nobody measured (DiagnosisOptions::tune), with the values in force, units and ranges.
  const std::vector<Parameter>& tuned() const { return tuned_; }
  Eigen::Index tunedCount() const { return static_cast<Eigen::Index>(tuned_.size()); }
  /// Their values at coordinates: value in force * exp(z), within the range; none for no coordinates.
  std::vector<std::pair<std::string, double>> tunedAt(const Eigen::VectorXd& z) const;
  static Eigen::VectorXd clampedTuning(const Eigen::VectorXd& z) { return z.cwiseMax(-farthest_tuning).cwiseMin(farthest_tuning); }
  /// What the model's force law gives for a muscle at a pressure and a length, N.
  double tensionN(int muscle, double pressure_ratio, double length_mm) const;

  /// Simulates up to the end of the stretches that are asked for (`end_row`; 0: all rows). May be called from several threads. What was
  /// asked for before is not simulated again.
  Prediction predict(int recording, const Model& model, int end_row = 0, Fidelity fidelity = Fidelity::fine) const;
  /// The same with other commands in place of the recorded ones; `commands[row][muscle]`.
  Prediction predict(int recording, const Model& model, const std::vector<std::vector<double>>& commands, int end_row,
                     Fidelity fidelity) const;
  /// All signals of the model under a schedule that was never recorded; samples that an effect loses are drawn. Nothing if it diverges.
  std::optional<Recording> predictSchedule(const Recording& schedule, const Model& model, Fidelity fidelity) const;

  /// The model as built, to be asked, never to be stepped.
  Simulation& model() const { return *reference_; }
  /// The robot as built.
  RobotDrawing drawing() const;
  bool hasHand() const;

  /// Different simulations, and seconds of them.
  long simulationCount() const { return simulation_count_; }
  double simulatedS() const { return static_cast<double>(simulated_ms_) / ms_per_s; }
  /// Threads that simulations may be shared among; 0: one per core.
  int jobCount() const { return options_.job_count; }
  bool interrupted() const { return options_.interrupted && options_.interrupted(); }

 private:
  static constexpr double farthest_tuning = 4;  ///< bound of |ln(value / value in force)|

  void dropDeadSegments();
  void compareSignals();
  void requireNumbers(const std::vector<Segment>& part) const;
  Parameter numberNamed(const std::string& name) const;
  Fidelity possible(Fidelity fidelity) const;
  void count(double simulated_s) const;
  enum class HeldSamples { as_measured, drawn };
  std::optional<ReplayResult> simulated(const Recording& recording, const Model& model, Fidelity fidelity, HeldSamples held) const;
  Prediction replay(Recording recording, const Model& model, int end_row, Fidelity fidelity) const;
  bool takesForEver(const Recording& recording, const ReplayOptions& options) const;
  void holdSamples(int recording, const Model& model, Prediction& prediction) const;

  std::vector<Recording> recordings_;
  const DiagnosisOptions& options_;
  std::vector<ComparedSignal> signals_;
  std::vector<std::vector<std::vector<double>>> measured_;  ///< [recording][signal][row]
  std::vector<std::string> notes_;
  Split split_;
  std::unique_ptr<Simulation> reference_;  ///< the model as built; asked about its parts, never stepped
  std::vector<std::pair<std::string, double>> nominal_;
  std::vector<Parameter> tuned_;
  mutable std::atomic<long> simulation_count_{0}, simulated_ms_{0};
  mutable PredictionStore store_;
};

}  // namespace musclesim
