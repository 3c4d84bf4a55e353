/// Plans the next experiment: commands that distinguish hypotheses which the recordings do not.
#pragma once

#include <vector>

#include "../fit/rival.h"
#include "../fit/sensitivity.h"
#include "../model/plant.h"
#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// Simulates the rivals, the named one first, under all schedules of the bank and returns the most informative one. Its worth is the
/// sum over pairs of the product of their probabilities and 1 - exp(-e), with e = nats_per_misfit / (recordings + 1) * mean over signals
/// and their averages of ln(RMS difference / sigma), sigma with the share of the gap that a law may leave: about what a recording of the
/// schedule would add to the log odds (a sum over pairs of models as in Box and Hill 1967, eq. 3.5, but bounded, so that it counts pairs
/// and not how far apart they are). Of the six best schedules it takes the best after either rival has been refitted, linearised, to its
/// recordings and the other's prediction together (T-optimality, Atkinson and Fedorov 1975): a difference that refitting removes tells
/// nothing. Amplitudes are reduced until every rival is predicted to stay about where the plant has been and clear of the stops of joints
/// and muscles, where small differences decide how the motion continues. Returns no commands for fewer than two rivals, if no schedule is
/// safe, or if the worth of each stays below a share (`worth_it`) of its largest possible value.
Experiment nextExperiment(const Plant& plant, const std::vector<Rival>& rivals, Fidelity fidelity, int job_count,
                          const OnSimulation& on_simulation);

}  // namespace musclesim
