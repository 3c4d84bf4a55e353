/// Which commands would tell explanations apart that the recordings do not.
#pragma once

#include "attribute.h"

namespace musclesim {

/// Simulates each model, as fitted, under a small bank of schedules and returns that under which the two most alike differ most, in units
/// of the noise floor. Without commands if there are fewer than two models.
Experiment nextExperiment(const Plant& plant, const std::vector<std::string>& labels, const std::vector<Model>& models, int job_count,
                          const OnSimulation& on_simulation);

}  // namespace musclesim
