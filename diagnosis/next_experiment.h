/// Which commands would tell explanations apart that the recordings do not.
#pragma once

#include "attribute.h"

namespace musclesim {

/// Simulates each model, as fitted, under a small bank of schedules and returns that under which the two most alike differ most, in units
/// of the noise floor. Commands are made smaller until the plant is predicted to stay about where it was in the recordings. Without
/// commands if there are fewer than two models.
Experiment nextExperiment(const Plant& plant, const std::vector<std::string>& labels, const std::vector<Model>& models, Fidelity fidelity,
                          int job_count, const OnSimulation& on_simulation);

/// A schedule of that bank for the plant of some recordings, as a recording without measurements: Experiment::schedule names it.
/// `amplitude` 0..1: share of the range that each command has in the recordings. Throws BadParameter for an unknown name.
Recording experimentSchedule(const std::string& name, double amplitude, const std::vector<Recording>& recordings);

}  // namespace musclesim
