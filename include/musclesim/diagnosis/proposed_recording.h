/// The next experiment of a diagnosis as a file that can be played on the machine and replayed by the model.
#pragma once

#include <string>

#include "musclesim/diagnosis/diagnosis.h"

namespace musclesim {

/// A recording of commands without readings: the text of NAME.csv and of its sidecar NAME.json.
struct ProposedRecording {
  std::string csv, json;
};

/// The sidecar members that describe the diagnosed model: those of one of the recordings, with what `model` replaces. Without the model's
/// further effects, which are not part of a recording.
RecordingInfo diagnosedModel(const Recording& recording, const ReplayOptions& model);

/// The commands that the diagnosis proposes, for the plant that `model` describes (diagnosedModel). Both texts are empty if the diagnosis
/// proposes nothing.
/// A robot file is named relative to the folder of `sidecar`, the file that the sidecar will be.
ProposedRecording proposedRecording(const Diagnosis& diagnosis, const RecordingInfo& model, const std::string& sidecar = "next.json");

}  // namespace musclesim
