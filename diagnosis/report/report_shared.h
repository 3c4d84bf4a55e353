/// What the parts of report.html share: pieces of markup, and what the page shows of a diagnosis.
#pragma once

#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"
#include "report_figures.h"

namespace musclesim::report {

constexpr double rather_none = 0.5;  ///< probability of something else from which on an explanation is believed in part only

std::string heading(const std::string& words);
/// A label with a possible line break after each of its words.
std::string breakable(const std::string& label);
std::string breakableCode(const std::string& label);
std::string paragraph(const std::string& words);
/// A command that is split over lines only before an option.
std::string command(const std::string& words);
/// A paragraph that introduces the following figure or table, with markup.
std::string lead(const std::string& markup);
std::string small(const std::string& words);

/// Whether there is a model with effects to compare with the one without.
bool hasAfter(const Diagnosis& d);
/// The gap with the effects found, or else with the best rejected explanation.
const Gap& gapAfter(const Diagnosis& d);
double percentLeft(const Diagnosis& d);
std::vector<std::string> comparedSignals(const Diagnosis& d);
/// The effects of the explanation that the page shows, found or rejected, on the way from command to sensor.
std::vector<FoundEffect> shownEffects(const Diagnosis& d);
/// RMS residual over the noise floor, over all signals.
double overNoiseInAll(const Gap& gap);
/// Whether more is left than noise and what the step size changes.
bool isRestLeft(const Diagnosis& d);
/// The effects that all explanations share which are as good as the best one.
std::vector<std::string> sharedEffects(const Diagnosis& d);
/// Whether an explanation without one of the causes found would do as well.
bool isAmbiguous(const Diagnosis& d);
Belief beliefOf(const Diagnosis& d);
/// "other load (the hand) with leak (muscle 0)".
std::string effectTitles(const std::vector<std::string>& labels);
/// The options with which another command uses what was found.
std::string fileOptions(const Diagnosis& d);
/// " --substeps 20" if the model was simulated in other internal steps than a replay takes by itself; empty otherwise.
std::string substepsOption(const Diagnosis& d);

}  // namespace musclesim::report
