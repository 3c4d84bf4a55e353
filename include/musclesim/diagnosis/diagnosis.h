/// The sim-to-real gap: how large it is, where it arises, which unmodelled effect causes it and how much of it that effect removes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/log/active_effect.h"
#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"

namespace musclesim {

class RecordFile;

/// Progress of a diagnosis, for a progress line.
struct DiagnosisProgress {
  std::string phase;  ///< in a few words
  long done = 0;      ///< simulations so far
  long expected = 0;  ///< expected in all; equal to `done` where that is not known, or more have been done than were expected
};

/// Parts of the method that a study may leave out, to measure what they are worth:
/// - nuisances: the tolerances of the model's numbers; the values that the user gave then count as exact
/// - stand_ins: trying other effects in the place of each member of the best sets
/// - tempering: misfit is then the sum of (residual / noise)^2 / 2 over all readings, as if the laws of all effects were exact
enum class MethodPart { nuisances, stand_ins, tempering };
/// Throws BadParameter for an unknown name.
MethodPart methodPartNamed(const std::string& name);

inline constexpr int most_effects = 6;  ///< in an explanation

struct DiagnosisOptions {
  ReplayOptions model;                  ///< the user's model
  std::vector<std::string> candidates;  ///< ids of effects to consider; empty: the whole catalogue
  std::vector<std::string> exclude;     ///< ids not to consider
  std::vector<std::string> tune;        ///< names of parameters of the model that nobody measured; they are fitted first
  bool trust_columns = false;           ///< take units, zeros, signs and order of the columns as they are: do not refuse doubtful ones
  /// Readings of this many seconds at the beginning of every recording are left out; without it, as the sidecars say, and a second of
  /// recordings that turn out to begin in the middle of a motion.
  std::optional<double> skip_start_s;
  double smallest_gap_percent = 1;    ///< of a signal's motion: a gap that is smaller in all signals is none. 0: every gap beyond the noise
  int max_effects = 4;                ///< largest number of effects in an explanation, 1..most_effects
  std::vector<ActiveEffect> earlier;  ///< an earlier finding: a set that the search begins with, fitted anew and kept if it is believed
  std::set<MethodPart> left_out;      ///< what the method does without, for studies
  int job_count = 0;                  ///< threads; 0: one per core. The answer does not depend on it
  std::uint64_t seed = 1;             ///< of the bootstrap and the negative control
  /// Keeps the simulations, and has those of an earlier diagnosis of the same recordings with the same options, by the same program: they
  /// are not repeated. Null: nothing is kept.
  RecordFile* kept = nullptr;
  std::function<void(const DiagnosisProgress&)> progress;  ///< called from one thread at a time
  std::function<bool()> interrupted;                       ///< return true to stop soon; the result is then partial
};

/// `no_gap`: no residual beyond the noise, or only a SmallGap; `effects_found`; `unexplained`: a gap that no effect of the catalogue
/// removes; `not_excited`: the recordings do not move the plant enough to tell.
enum class Verdict { no_gap, effects_found, unexplained, not_excited };
std::string nameOf(Verdict verdict);

/// A value with its 95 % interval; the whole possible range if the recordings do not determine it.
struct Estimate {
  double value = 0, low = 0, high = 0;
  bool is_determined = true;
};

struct Place {
  std::string stage, component, phase;
  double share = 0;           ///< of the gap
  bool is_ruled_out = false;  ///< the signals contradict this stage; the shares of the other stages rest on likeness alone
};

struct FoundEffect {
  std::string id, component;
  double probability = 0;
  std::map<std::string, Estimate> parameters;
  std::optional<double> reduction_percent = {};     ///< reduction of the gap on the held-out data by this effect alone
  std::optional<double> removes_percent = {};       ///< of a chosen effect: what it removes of the gap while the others are present
  std::map<std::string, std::string> choices = {};  ///< parameters that are words, such as the end of a muscle or the side of a wall
  std::string label() const { return id + "@" + component; }
};

struct ExplanationProbability {
  std::vector<std::string> effects;  ///< "id@component"; empty: no effect at all
  double probability = 0;
};

struct SignalGap {
  double rmse = 0, noise_sigma = 0;
  double motion = 0;  ///< RMS of the readings about their mean
};

/// A gap beyond the noise that is too small beside the motion to look for its causes: of no signal as large as
/// DiagnosisOptions::smallest_gap_percent. Given is the signal of which it is the largest share.
struct SmallGap {
  std::string signal;
  double percent_of_motion = 0;  ///< 100 sqrt(RMSE^2 - sigma^2) / motion
};

/// normalised = mean over signals of max(0, RMSE^2 - sigma^2) / sigma^2; signals and sigmas pooled over the recordings.
struct Gap {
  double normalised = 0;
  std::map<std::string, SignalGap> per_signal;
};

/// A simulated motion that is sensitive, as after an impact on a stop: internal steps twice as long change it noticeably; or, where the
/// robot has so few of them that they cannot be longer, muscles that all pull a thousandth harder do.
struct Unsteady {
  enum class Change { steps, forces };
  std::string signal;                      ///< the signal that changes most; empty if none does noticeably
  double in_sigmas = 0, share_of_gap = 0;  ///< RMS of the change over sigma, and over the RMS of the gap
  /// Of every signal the largest RMS of the change over sigma in any segment.
  std::map<std::string, double> all_in_sigmas = {};
  Change by = Change::steps;
};

struct Experiment {
  std::vector<std::string> separates;
  std::string schedule, why;  ///< name of the schedule, and its purpose in words
  double amplitude = 1;       ///< of the commands' range in the recordings
  double level = 0;           ///< offset of the commands from the middle of that range, in units of it
  std::vector<double> time_s;
  std::vector<std::vector<double>> commands;  ///< per row one value per muscle; empty if there is nothing to distinguish
  double difference = 0;                      ///< least RMS difference between the hypotheses it separates, in units of sigma
};

/// A residual block: one signal of one recording (or of a part of one) to which hypotheses are fitted.
struct FittedBlock {
  std::string recording, signal;
  double sigma = 0, rms_before = 0;
  int averaged_rows = 0;   ///< rows per average; 0: as recorded
  bool is_parity = false;  ///< what of the signal contradicts the other signals of motion
};

/// A fitted explanation and the RMS residual that it leaves in each block.
struct Trial {
  std::vector<std::string> effects;
  int parameter_count = 0;
  std::vector<double> rms;
  std::vector<double> misfits, complexity;            ///< what its odds are computed from (Evidence), without weights
  double numbers_cost = 0;                            ///< nats for numbers of the model that are off their value
  double score = 0;                                   ///< ln odds up to a constant
  std::vector<std::map<std::string, double>> values;  ///< parameters of each effect
};

/// Share of the log misfit that one effect would remove by screening, 0..1.
struct Screening {
  std::string effect;
  double removed = 0;
};

/// RMS residual over sigma, pooled over all signals of the held-out data, while commands rise, fall or rest.
struct PhaseGap {
  std::string phase;
  double before = 0, after = 0;  ///< after: 0 if nothing was chosen
};

/// Front view of the robot as built, in which the report marks a component.
struct RobotDrawing {
  struct Line {
    std::string component;  ///< "muscle_0"; bones and springs have none
    std::vector<Eigen::Vector2d> points_mm;
    double width_mm = 0;
    std::string title = "bone";  ///< in words
  };
  struct Point {
    std::string component;  ///< "joint_elbow", "hand"
    Eigen::Vector2d point_mm;
  };
  std::vector<Line> lines;  ///< from back to front
  std::vector<Point> points;
};

/// What the chosen effects leave on the held-out data.
struct Remainder {
  bool is_significant = false;   ///< it stands out of the noise, and of what the step size changes
  bool is_within_steps = false;  ///< it stands out of the noise, but internal steps twice as long change the signals by as much
  std::string stage, signal;     ///< of the signal that stands out most
  double in_sigmas = 0;          ///< RMS over sigma there
  std::string shape;             ///< in words, empty if it has no simple one
  double percent_of_gap = 0;
  double probability = 0;  ///< that something acts which the chosen effects do not hold
};

/// A number of the model with a tolerance, as the chosen explanation fits it.
struct FittedNumber {
  std::string name, unit;
  double start = 0;
  Estimate fitted;
  double in_tolerances = 0;  ///< ln(fitted / start) over the tolerance
};

/// Curves of one signal of one recording, for the report.
struct Trace {
  std::string recording, signal;
  std::vector<double> time_s, measured, before, after;
};

/// A parameter of the model that was fitted to the recordings before the gap was diagnosed.
struct TunedParameter {
  std::string name, unit;
  double start = 0;
  Estimate fitted;        ///< without any effect
  Estimate with_effects;  ///< together with the chosen effects; equal to `fitted` if none was chosen
};

/// The gap that is left on the held-out data once this effect is added to those before it.
struct RemovalStep {
  std::string effect;  ///< "id@component"
  double left_percent = 0;
};

/// The best rejected hypothesis of the verdict `unexplained`.
struct Attempt {
  std::vector<std::string> effects;          ///< "id@component"
  std::vector<ActiveEffect> active_effects;  ///< with the fitted parameters
  Gap after;
  double reduction_percent = 0, reduction_low_percent = 0, reduction_high_percent = 0;
};

/// A number of the robot's description that was taken as exact. With another value, and everything else fitted anew, the model explains the
/// fitted recordings as well without some of the named effects.
struct NumberInstead {
  std::string name, unit;
  double given = 0, instead = 0;
  std::vector<std::string> effects;  ///< that it takes the place of, "id@component"
};

struct Diagnosis {
  std::string robot;
  std::vector<std::string> muscle_names;  ///< that the robot gave its muscles, in their order; empty if they only have numbers
  std::vector<std::string> recordings;
  Verdict verdict = Verdict::no_gap;
  std::vector<Place> where;
  std::string where_method;  ///< the evidence, in words
  std::vector<FoundEffect> effects;
  double none_of_these = 0;
  std::vector<std::string> candidates;  ///< ids of the candidates, if they are not the whole catalogue
  std::vector<ExplanationProbability> explanations;
  std::vector<std::string> chosen, ambiguity_set;
  std::vector<ActiveEffect> chosen_effects;
  Gap before, after;
  Attempt attempt;       ///< of the verdict `unexplained`; without effects if there is none
  std::string held_out;  ///< the held-out data, in words
  double reduction_percent = 0, reduction_low_percent = 0, reduction_high_percent = 0;
  std::vector<std::vector<std::string>> ambiguity_sets;  ///< sets of effects that the data cannot tell from the chosen one, that one first
  Remainder remainder;
  std::vector<FittedNumber> numbers;
  std::vector<NumberInstead> numbers_instead;
  std::vector<RemovalStep> removal;       ///< the chosen effects, added one after another; empty if there are fewer than two
  std::vector<std::string> alternatives;  ///< the same as words, "a@x + b@y"; empty if there is only the chosen one
  std::string model_options;              ///< options of the program for the robot of the recordings: "--robot rig --set rig.load_kg=2"
  std::vector<std::string> refitted;      ///< parameters of the model that the nominal refit re-tunes
  double nominal_refit_percent = 0, negative_control_percent = 0, unexplained_percent = 0;
  std::vector<TunedParameter> tuned;  ///< of DiagnosisOptions::tune; before and after are gaps of the model with these values
  std::vector<std::string>
      model_effects;                     ///< "id@component" of effects that the diagnosed model has already: the recordings' active_effects
  std::vector<std::string> not_excited;  ///< effects that these recordings could not have shown
  std::vector<std::string> odd_recordings;  ///< sentences on recordings that are explained far worse than all others
  std::string unknown_start;                ///< a sentence on recordings that begin in the middle of a motion; empty if there are none
  std::vector<std::string> notes;           ///< remarks on the data and the answer for the user
  std::optional<SmallGap> small_gap;        ///< with `no_gap` only
  bool held_out_is_noise = false;           ///< the model without effects leaves only noise there, so that nothing can be confirmed
  Unsteady unsteady;
  Experiment next_experiment;
  std::vector<Screening> screenings;  ///< best first
  std::vector<FittedBlock> blocks;
  std::vector<Trial> trials;  ///< best first
  std::vector<PhaseGap> phases;
  RobotDrawing drawing;
  std::vector<Trace> traces;
  bool partial = false;
  /// Internal steps per control step of the simulations, if a replay would take others by itself; otherwise 0.
  int substeps = 0;
  double simulated_s = 0, wall_s = 0;
  long simulation_count = 0;
};

/// Diagnoses recordings of one plant. Throws BadFile for recordings that cannot be diagnosed together (different robots, no commands, fewer
/// than ten numbers of each signal, no signal that the model also has), BadParameter for options out of range and unknown effects, and
/// Diverged if the model without further effects cannot follow the recordings.
Diagnosis diagnose(std::vector<Recording> recordings, const DiagnosisOptions& options = {});

/// diagnosis.json, format musclesim-diagnosis-1.
std::string diagnosisJson(const Diagnosis& diagnosis, const std::string& schedule_file = "next.csv");

/// How a report came to be, for its last lines; empty: not told.
struct ReportOrigin {
  std::string date, command_line;
};
/// report.html: a self-contained page.
std::string diagnosisReport(const Diagnosis& diagnosis, const ReportOrigin& origin = {});

/// nominal.toml: the numbers of the model that were fitted together with the effects, as a file for --config; empty if none was. The gap
/// reduction is that of effects and numbers together.
std::string fittedNumbersToml(const Diagnosis& diagnosis);

/// A summary for the terminal that takes ten seconds to read.
std::string diagnosisSummary(const Diagnosis& diagnosis);

}  // namespace musclesim
