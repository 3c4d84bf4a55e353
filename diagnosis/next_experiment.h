/// Which commands would tell explanations apart that the recordings do not.
#pragma once

#include <vector>

#include "musclesim/diagnosis/diagnosis.h"
#include "plant.h"
#include "rival.h"
#include "sensitivity.h"

namespace musclesim {

/// Simulates contenders, the likeliest first, under the schedules of the bank and returns the one that is expected to tell most: the sum
/// over pairs of the product of their probabilities and 1 - exp(-e), e = per_misfit / (recordings + 1) * mean of ln(RMS difference over
/// floor) over signals and their averages, the floor that of Odds, about what a recording of it would add to the log odds (a sum over pairs
/// of models as in Box and Hill 1967, eq. 3.5, but bounded, so that it counts pairs and not how far apart they are). Of the six best by
/// that, the best by what is left of the differences when either contender is fitted anew to its recordings and the other's prediction
/// together, linearised (T-optimality, Atkinson and Fedorov 1975): what a change of its numbers takes up tells nothing. Schedules are made
/// smaller until every contender is predicted to keep about where the plant has been, and clear of the stops of joints and muscles, where
/// small differences decide what happens next. Without commands if there are fewer than two contenders, or if nothing tells any of them
/// apart.
Experiment nextExperiment(const Plant& plant, const std::vector<Rival>& rivals, Fidelity fidelity, int job_count,
                          const OnSimulation& on_simulation);

}  // namespace musclesim
