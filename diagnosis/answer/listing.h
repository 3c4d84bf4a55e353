/// What a diagnosis lists: effects with their probabilities, ambiguity, trials, numbers of the model, the held-out rows.
#pragma once

#include <string>
#include <vector>

#include "../search/search.h"
#include "musclesim/diagnosis/diagnosis.h"
#include "verdict.h"

namespace musclesim {

/// The chosen explanation, and all that the recordings cannot distinguish from the likeliest one.
std::vector<const Explanation*> asGood(const Search& search);
/// "a@x + b@y"
std::string wordsOf(const Search& search, const Explanation& explanation);

/// Labels none of whose variants would have shown; labels that were never simulated are not listed.
void listNotExcited(const Search& search, Diagnosis& diagnosis);
/// Probabilities per effect and per explanation, what each chosen effect removes, and the ambiguity sets.
void listEffects(const Search& search, const HeldOut& held_out, const DiagnosisOptions& options, Diagnosis& diagnosis);
/// The screened and the fitted hypotheses.
void listTrials(const Search& search, Diagnosis& diagnosis);
/// The numbers of the model as fitted with an explanation: those known within tolerances, and the tuned ones.
void listNumbers(const Plant& plant, const Explanation& fitted, Diagnosis& diagnosis);
/// The held-out rows: curves, the gap by actuation phase, and the remainder. `after`: residual with the explanation that is offered; empty
/// if none is.
void listHeldOut(const Search& search, const HeldOut& held_out, const Eigen::VectorXd& after, Diagnosis& diagnosis);

}  // namespace musclesim
