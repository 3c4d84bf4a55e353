/// The arguments of `musclesim diagnose`, and what a diagnosis that is to be gone on with depends on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "musclesim/diagnosis/diagnosis.h"
#include "musclesim/log/recording.h"
#include "options.h"

namespace musclesim::command_line {

struct DiagnoseArguments {
  std::vector<std::string> recordings, candidates, exclude, ignore_columns, tune;
  std::optional<std::string> out, json, fixed_effects;
  int jobs = 0, max_effects = 4;
  double smallest_gap_percent = DiagnosisOptions().smallest_gap_percent;
  bool without_active_effects = false, resume = false, trust_columns = false;
  std::optional<double> skip_start_s;
};

/// All that the answer depends on, by name, as one line of JSON: the recordings, the diagnosed model, the options, and the program with its
/// libraries.
std::string diagnosisOrigin(const std::vector<Recording>& recordings, const RecordingInfo& plant, const ModelOptions& model,
                            const DiagnoseArguments& arguments);

/// Throws BadParameter, which names what differs, unless both are equal. `kept`: of the unfinished diagnosis in `folder`.
void requireSameOrigin(const std::string& kept, const std::string& now, const std::string& folder);

}  // namespace musclesim::command_line
