/// The recordings of one plant and the model that they are compared with.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "../data/noise_sigma.h"
#include "musclesim/base/units.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/effect/catalogue.h"
#include "musclesim/simulation/replay.h"
#include "parity.h"
#include "prediction_store.h"

namespace musclesim {

/// A signal that both the recordings and the model have.
struct ComparedSignal {
  std::string name;
  NoiseSigma sigma;
};

inline constexpr int fewest_compared_rows = 10;  ///< a signal with fewer numbers in a segment is not compared there

/// A part of one recording. Simulations always begin at the recording's first row; only the rows of the segment, or every n-th of them, are
/// compared.
struct Segment {
  int recording = 0;
  int first_row = 0, end_row = 0;
  int every = 1;
};

/// The segments on which parameters are fitted and hypotheses chosen, and the held-out ones, which only measure the result.
struct Split {
  std::vector<Segment> fit, held_out;
  std::string held_out_words;
};

/// Time step of a simulation: each level doubles the step of the one before, which costs less. The error is nearly the same for all models
/// of one plant, so differences between coarse predictions are valid (Comparison corrects for the rest). `finer` is half the fine step: a
/// fit simulates with it to learn how large the error of the fine step is.
enum class Fidelity { finer = -1, fine, medium, coarse, coarsest };

/// Which signals of a prediction are asked for. Pressures alone need no simulation of the body.
enum class Focus { pressures, all_signals };

/// A model: effects and changed parameters added to the user's own.
struct Model {
  std::vector<ActiveEffect> effects;
  std::vector<std::pair<std::string, double>> parameters;
};

/// Muscles that all pull a thousandth harder: no model is known better than that.
Model slightlyStronger();

/// A number of the model whose true value differs from the one the user gave by a factor exp(tolerance * eta), eta standard normal.
struct UncertainNumber {
  Parameter parameter;  ///< with the value that the user gave
  double tolerance;     ///< standard deviation of ln(true value / given value)
  bool is_tuned;        ///< named by DiagnosisOptions::tune
};

class Plant {
 public:
  /// `given`: what the user gave for the numbers that options.model has fitted values of since. Throws as diagnose().
  Plant(std::vector<Recording> recordings, const DiagnosisOptions& options, const std::map<std::string, double>& given = {});

  const std::vector<Recording>& recordings() const { return recordings_; }
  const std::vector<ComparedSignal>& signals() const { return signals_; }
  /// Notes on faults of the recordings and how they were handled.
  const std::vector<std::string>& notes() const { return notes_; }
  const Split& split() const { return split_; }
  /// Segments for screening: of up to three recordings with different commands, from the beginning to 4 s after the first change of a
  /// command (12 s for one recording, 6 s for two) and at least 400 rows after it (1200, 600); recordings with more than 100 rows per
  /// second are thinned to that number of rows.
  std::vector<Segment> screeningSegments() const;
  const std::string& robot() const { return recordings_.front().info.robot; }
  int muscleCount() const { return recordings_.front().muscleCount(); }
  /// Whether the user's model already has effects of a stage, by options or by a sidecar.
  bool holds(Stage stage) const;
  /// The measured values of a compared signal; empty if this recording does not have it.
  const std::vector<double>& measured(int recording, int signal) const;
  /// How the signals of motion of a recording must agree with each other. Thread-safe.
  const ParityRelations& parity(int recording) const;
  /// Whether nothing tells how a recording begins: neither a sidecar nor an option, and this program did not simulate it.
  bool beginsUnknown(int recording) const;
  /// All components of the robot on which an effect can act.
  std::vector<std::string> componentsFor(const EffectInfo& info) const;
  /// Whether a component "signal_<stem>" (or "all") names a compared signal.
  bool compares(const std::string& signal_component) const;
  static bool isComponentOf(const std::string& component, const std::string& signal_name);
  /// Shortest and longest length of a muscle.
  struct MuscleRange {
    double minimum_mm, maximum_mm;
  };
  MuscleRange muscleRange(int muscle) const;
  /// Parameters of the model itself that no effect of the catalogue represents, with the values in force: the nominal refit re-tunes them.
  const std::vector<std::pair<std::string, double>>& nominalParameters() const { return nominal_; }
  /// Numbers of the model that are known with an error only: those of a tolerance in a sidecar or a robot file, and DiagnosisOptions::tune.
  /// Every explanation fits them along with its effects.
  const std::vector<UncertainNumber>& numbers() const { return numbers_; }
  /// Numbers of the robot's own description that count as exact: they have no tolerance, do not vary between the recordings and are not 0.
  std::vector<Parameter> exactNumbers() const;
  Eigen::Index numberCount() const { return static_cast<Eigen::Index>(numbers_.size()); }
  /// Coordinates at which the numbers have the values in force: 0, except for tuned ones.
  const Eigen::VectorXd& numbersInForce() const { return numbers_in_force_; }
  /// The numbers at coordinates eta that differ from those in force: given value * exp(tolerance * eta), within the range; none for an
  /// empty eta.
  std::vector<std::pair<std::string, double>> numbersAt(const Eigen::VectorXd& eta) const;
  double numberAt(Eigen::Index index, double eta) const;
  /// The coordinates within four tolerances and such that the robot can be built. Where it cannot, one number after the other goes as far
  /// as those before it allow, for example a moment of inertia that a mass needs. `margin`: how far each number alone may still change
  /// from there; 0 if the given values do not allow that.
  Eigen::VectorXd clampedNumbers(const Eigen::VectorXd& eta, double margin = 0) const;
  /// Tension of a muscle by the model's force law at a pressure and a length, N.
  double tensionN(int muscle, double pressure_ratio, double length_mm) const;

  /// Simulates a recording up to `end_row` (0: all rows). Thread-safe. A model that was asked for before is not simulated again, nor is one
  /// that differs from it only in effects of sensors without memory (EffectInfo::is_memoryless). With the focus on pressures the values of
  /// all other signals may be anything.
  Prediction predict(int recording, const Model& model, int end_row = 0, Fidelity fidelity = Fidelity::fine,
                     Focus focus = Focus::all_signals) const;
  /// The same with other commands in place of the recorded ones; `commands[row][muscle]`.
  Prediction predict(int recording, const Model& model, const std::vector<std::vector<double>>& commands, int end_row,
                     Fidelity fidelity) const;
  /// All signals of the model under a schedule that was not recorded; samples that an effect loses are drawn at random. Empty if it
  /// diverges.
  std::optional<Recording> predictSchedule(const Recording& schedule, const Model& model, Fidelity fidelity) const;

  /// The model as built, for queries; it is never stepped.
  Simulation& model() const { return *reference_; }
  /// Whether simulated and recorded motions differ by the error of the time step: machines have no internal steps, but recordings of this
  /// program are replayed in those they were made in.
  bool hasStepError() const;
  /// Internal steps per control step in fine simulations, and whether they are others than a replay takes by itself.
  int substeps() const { return substeps_; }
  bool hasOwnSubsteps() const { return options_.model.substeps > 0 || substeps_ != reference_->substeps(); }
  /// The robot as built.
  RobotDrawing drawing() const;
  /// Diagnosis::muscle_names.
  std::vector<std::string> muscleNames() const;
  bool hasHand() const;
  /// Where the model without effects has the hand in the rows of a recording, mm. No rows if nothing is the hand, or if the model diverges.
  Eigen::MatrixX3d nominalHandMm(int recording) const;

  /// The fidelity itself if coarser steps save time on this robot, otherwise fine.
  Fidelity possible(Fidelity fidelity) const;
  /// Number of distinct simulations under recorded or changed commands and of all under proposed schedules, and the seconds simulated;
  /// those of pressures alone do not count.
  long simulationCount() const { return simulation_count_; }
  double simulatedS() const { return static_cast<double>(simulated_ms_) / ms_per_s; }
  /// Threads to use; 0: one per core.
  int jobCount() const { return options_.job_count; }
  bool leavesOut(MethodPart part) const { return options_.left_out.contains(part); }
  bool interrupted() const { return options_.interrupted && options_.interrupted(); }

 private:
  void dropDeadSegments();
  void dropAfterDropouts();
  void dropStarts();
  void compareSignals();
  void requireNumbers(const std::vector<Segment>& part) const;
  int firstReading(const Segment& segment) const;
  Parameter numberNamed(const std::string& option, const std::string& name) const;
  std::map<std::string, double> declaredTolerances() const;
  void findNumbers(const std::map<std::string, double>& given);
  void findNominalParameters();
  void chooseSubsteps();
  bool changesNothing(const std::string& name, double value) const;
  void leaveOutWhatChangesNothing();
  double largestChangeInSigmas(const std::vector<Prediction>& one, const std::vector<Prediction>& other) const;
  int substepsOf(Fidelity fidelity) const;
  std::string simulationKey(int recording, std::size_t rows, Fidelity fidelity) const;
  void count(double simulated_s) const;
  enum class HeldSamples { as_measured, drawn };
  bool canBeBuilt(const Eigen::VectorXd& eta, double margin) const;
  bool pressuresNeedMotion(const Model& model) const;
  /// What is simulated of a model, and the effects whose readings are computed from the simulated values.
  struct Parts {
    Model simulated;
    std::vector<ActiveEffect> reading;
  };
  Parts partsOf(const Model& model) const;
  void read(std::vector<ActiveEffect> effects, Prediction& prediction) const;
  std::optional<ReplayResult> simulated(const Recording& recording, const Model& model, Fidelity fidelity, HeldSamples held,
                                        Focus focus = Focus::all_signals) const;
  Prediction replay(Recording recording, const Model& model, int end_row, Fidelity fidelity, Focus focus = Focus::all_signals) const;
  void holdSamples(int recording, const Model& model, Prediction& prediction) const;

  std::vector<Recording> recordings_;
  const DiagnosisOptions& options_;
  std::vector<ComparedSignal> signals_;
  std::vector<std::vector<std::vector<double>>> measured_;  ///< [recording][signal][row]
  std::vector<std::string> notes_;
  Split split_;
  std::unique_ptr<Simulation> reference_;  ///< the model as built, never stepped
  int substeps_ = 1;                       ///< internal steps per control step in fine simulations
  std::vector<std::pair<std::string, double>> nominal_;
  std::vector<UncertainNumber> numbers_;
  Eigen::VectorXd numbers_in_force_;
  mutable std::atomic<long> simulation_count_{0}, simulated_ms_{0};
  std::string key_of_tuned_;  ///< the values in force of the tuned numbers
  mutable PredictionStore store_;
  mutable std::mutex access_to_parity_;
  mutable std::map<int, ParityRelations> parity_;  ///< by recording, where asked for
  mutable std::mutex access_to_built_;
  mutable std::map<std::vector<double>, bool> built_;  ///< canBeBuilt() by coordinates
};

}  // namespace musclesim
