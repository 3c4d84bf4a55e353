/// The sim-to-real gap: how large it is, where it arises, which unmodelled effect causes it and how far that effect closes it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "musclesim/log/active_effect.h"
#include "musclesim/log/recording.h"
#include "musclesim/simulation/replay.h"

namespace musclesim {

/// What a diagnosis is doing, for a progress line.
struct DiagnosisProgress {
  std::string phase;  ///< in a few words
  long done = 0;      ///< simulations since the start
  long expected = 0;  ///< in all, as far as is known by now
};

struct DiagnosisOptions {
  ReplayOptions model;                                     ///< the simulator as the user has it
  std::vector<std::string> candidates;                     ///< ids of effects to consider; empty: the whole catalogue
  std::vector<std::string> exclude;                        ///< ids not to consider
  std::vector<std::string> tune;                           ///< numbers of the model to fit first: those that nobody measured
  int max_effects = 2;                                     ///< how many effects an explanation may have, 1..6
  int job_count = 0;                                       ///< threads; 0: one per core. The answer does not depend on it
  std::uint64_t seed = 1;                                  ///< of the bootstrap and the sham
  std::function<void(const DiagnosisProgress&)> progress;  ///< called from one thread at a time
  std::function<bool()> interrupted;                       ///< true: stop soon and return what is known
};

/// `no_gap`: nothing beyond the noise floor; `effects_found`; `unexplained`: a gap that no effect of the catalogue removes;
/// `not_excited`: the recordings do not move the plant enough to tell.
enum class Verdict { no_gap, effects_found, unexplained, not_excited };
std::string nameOf(Verdict verdict);

/// A value with its 95 % interval; all that is possible where the recordings do not determine it.
struct Estimate {
  double value = 0, low = 0, high = 0;
  bool is_determined = true;
};

struct Place {
  std::string stage, component, phase;
  double share = 0;           ///< of the gap
  bool is_ruled_out = false;  ///< the signals speak against this stage; among the others the share is likeness alone
};

struct FoundEffect {
  std::string id, component;
  double probability = 0;
  std::map<std::string, Estimate> parameters;
  double reduction_percent = 0;                     ///< of the gap on the held-out data, by this effect alone
  std::map<std::string, std::string> choices = {};  ///< parameters that are words: which end of a muscle, which side of a wall
  std::string label() const { return id + "@" + component; }
};

struct ExplanationProbability {
  std::vector<std::string> effects;  ///< "id@component"; empty: no effect at all
  double probability = 0;
};

struct SignalGap {
  double rmse = 0, noise_sigma = 0;
};

/// normalised = mean over signals of max(0, RMSE^2 - floor^2) / floor^2, signals and floors pooled over the recordings.
struct Gap {
  double normalised = 0;
  std::map<std::string, SignalGap> per_signal;
};

/// A motion that the model itself does not repeat in internal steps twice as long, as after an impact on a stop.
struct Unsteady {
  std::string signal;                      ///< that this moves most; empty: steady
  double in_sigmas = 0, share_of_gap = 0;  ///< RMS over the noise floor, and over that of the gap
};

struct Experiment {
  std::vector<std::string> separates;
  std::string schedule, why;  ///< name of the schedule, and what it is good for
  double amplitude = 1;       ///< of the commands' range in the recordings
  double level = 0;           ///< of the commands above the middle of that range, in units of it
  std::vector<double> time_s;
  std::vector<std::vector<double>> commands;  ///< per row, one per muscle; empty: there is nothing to tell apart
  double difference = 0;                      ///< RMS between what it separates at least, in units of the noise floor
};

/// One signal of one recording (or part of one) that explanations are fitted to.
struct FittedBlock {
  std::string recording, signal;
  double sigma = 0, rms_before = 0;
  int averaged_rows = 0;  ///< rows per block of the averaged signal; 0: as recorded
};

/// An explanation that was fitted: what it leaves of each cell.
struct Trial {
  std::vector<std::string> effects;
  int parameter_count = 0;
  std::vector<double> rms;
  std::vector<double>
      rms_cross_validated;  ///< the same with every recording predicted from a fit to the others; empty where that was not tried
  std::vector<std::map<std::string, double>> values;  ///< parameters of every effect
};

/// How much of the log misfit one effect would remove by the first look, of what there is, 0..1.
struct Screening {
  std::string effect;
  double removed = 0;
};

/// RMS residual over the floor, pooled over all signals of the held-out data, while commands rise, fall or rest.
struct PhaseGap {
  std::string phase;
  double before = 0, after = 0;  ///< after: 0 if nothing was chosen
};

/// The robot as built, seen from the front, for a picture that points at a component.
struct RobotDrawing {
  struct Line {
    std::string component;  ///< "muscle_0"; bones have none
    std::vector<Eigen::Vector2d> points_mm;
    double width_mm = 0;
  };
  struct Point {
    std::string component;  ///< "joint_elbow", "hand"
    Eigen::Vector2d point_mm;
  };
  std::vector<Line> lines;  ///< from back to front
  std::vector<Point> points;
};

/// Curves for the report: one recording, one signal.
struct Trace {
  std::string recording, signal;
  std::vector<double> time_s, measured, before, after;
};

/// A number of the model that was fitted to the recordings before the gap was asked about.
struct TunedParameter {
  std::string name, unit;
  double start = 0;
  Estimate fitted;        ///< without any effect
  Estimate with_effects;  ///< together with the chosen effects; as `fitted` if none was chosen
};

/// What comes nearest where no explanation is good enough to be believed.
struct Attempt {
  std::vector<std::string> effects;          ///< "id@component"
  std::vector<ActiveEffect> active_effects;  ///< with the fitted parameters
  Gap after;
  double reduction_percent = 0, reduction_low_percent = 0, reduction_high_percent = 0;
};

struct Diagnosis {
  std::string robot;
  std::vector<std::string> recordings;
  Verdict verdict = Verdict::no_gap;
  std::vector<Place> where;
  std::string where_method;  ///< in words: which signals decided
  std::vector<FoundEffect> effects;
  double none_of_these = 0;
  std::vector<std::string> candidates;  ///< ids that could be an answer, where that was not the whole catalogue
  std::vector<ExplanationProbability> explanations;
  std::vector<std::string> chosen, ambiguity_set;
  std::vector<ActiveEffect> chosen_effects;
  Gap before, after;
  Attempt attempt;       ///< of the verdict `unexplained`; without effects if there was nothing to try
  std::string held_out;  ///< what the gap was measured on, in words
  double reduction_percent = 0, reduction_low_percent = 0, reduction_high_percent = 0;
  std::vector<std::string> alternatives;  ///< where explanations cannot be told apart: of each, what the others do not hold
  std::string model_options;              ///< of the program, for the robot of the recordings: "--robot rig --set rig.load_kg=2"
  std::vector<std::string> refitted;      ///< numbers of the model that the nominal refit re-tunes
  double nominal_refit_percent = 0, negative_control_percent = 0, unexplained_percent = 0;
  std::vector<TunedParameter> tuned;     ///< of DiagnosisOptions::tune; before and after are gaps of the model with these
  std::vector<std::string> not_excited;  ///< effects that these recordings could not have shown
  std::vector<std::string> notes;        ///< what the user should know about data and answer
  Unsteady unsteady;
  Experiment next_experiment;
  std::vector<Screening> screenings;  ///< best first
  std::vector<FittedBlock> blocks;
  std::vector<Trial> trials;  ///< best first
  std::vector<PhaseGap> phases;
  RobotDrawing drawing;
  std::vector<Trace> traces;
  bool partial = false;
  double simulated_s = 0, wall_s = 0;
  long simulation_count = 0;
};

/// Diagnoses recordings of one plant. Throws BadParameter for recordings that cannot be diagnosed together (different robots, no commands,
/// fewer than 20 rows, no signal that the model also has) and for unknown effects; Diverged if the model itself, without further effects,
/// cannot follow the recordings.
Diagnosis diagnose(std::vector<Recording> recordings, const DiagnosisOptions& options = {});

/// The contract's diagnosis.json.
std::string diagnosisJson(const Diagnosis& diagnosis, const std::string& schedule_file = "next.csv");

/// report.html: one page that needs no other file.
std::string diagnosisReport(const Diagnosis& diagnosis);

/// The tuned parameters as a file for --config.
std::string tunedToml(const std::vector<TunedParameter>& parameters);

/// What a person can read in ten seconds.
std::string diagnosisSummary(const Diagnosis& diagnosis);

}  // namespace musclesim
