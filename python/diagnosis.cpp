#include <pybind11/stl.h>

#include <mutex>
#include <optional>

#include "bindings.h"
#include "conversions.h"
#include "interruption.h"
#include "musclesim/diagnosis/proposed_recording.h"
#include "musclesim/effect/effects_file.h"
#include "replay_options.h"

namespace musclesim::python {

namespace {

/// The newest progress, on its way from the diagnosis to the caller's thread.
class ProgressBox {
 public:
  void put(const DiagnosisProgress& progress) {
    const std::lock_guard lock(mutex_);
    newest_ = progress;
  }
  std::optional<DiagnosisProgress> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(newest_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<DiagnosisProgress> newest_;
};

/// Further files of the answer by name, as the program writes them.
py::dict filesOf(const Diagnosis& diagnosis, const RecordingInfo& plant) {
  py::dict files;
  if (!diagnosis.attempt.effects.empty()) files["attempt.json"] = effectsText(diagnosis.attempt.active_effects);
  if (const std::string numbers = fittedNumbersToml(diagnosis); !numbers.empty()) files["nominal.toml"] = numbers;
  if (const ProposedRecording next = proposedRecording(diagnosis, plant); !next.csv.empty()) {
    files["next.csv"] = next.csv;
    files["next.json"] = next.json;
  }
  return files;
}

py::dict answerOf(const Diagnosis& diagnosis, const RecordingInfo& plant) {
  py::dict answer;
  answer["files"] = filesOf(diagnosis, plant);
  answer["data"] = fromJson(diagnosisJson(diagnosis));
  answer["report"] = diagnosisReport(diagnosis);
  answer["summary"] = diagnosisSummary(diagnosis);
  answer["effects"] = fromJson(effectsText(diagnosis.chosen_effects)).attr("__getitem__")("effects");
  return answer;
}

/// Recordings that were made in memory get names: the answer speaks of them.
std::vector<Recording> named(std::vector<Recording> recordings, bool without_active_effects) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (recordings[i].file.empty()) recordings[i].file = "recording " + std::to_string(i + 1);
    if (without_active_effects) recordings[i].info.active_effects.clear();
  }
  return recordings;
}

py::dict diagnoseRecordings(const std::vector<Recording>& given, const py::dict& model, const std::vector<std::string>& candidates,
                            const std::vector<std::string>& exclude, const std::vector<std::string>& tune, double smallest_gap_percent,
                            int max_effects, int threads, std::uint64_t seed, const py::object& earlier, bool without_active_effects,
                            bool trust_columns, std::optional<double> skip_start_s, const py::object& progress) {
  const std::vector<Recording> recordings = named(given, without_active_effects);
  DiagnosisOptions options;
  options.model = replayOptionsFrom(model);
  options.candidates = candidates;
  options.exclude = exclude;
  options.tune = tune;
  options.smallest_gap_percent = smallest_gap_percent;
  options.max_effects = max_effects;
  options.trust_columns = trust_columns;
  options.skip_start_s = skip_start_s;
  options.job_count = threads;
  options.seed = seed;
  options.earlier = effectsFrom(earlier);
  ProgressBox box;
  options.progress = [&](const DiagnosisProgress& now) { box.put(now); };
  Diagnosis diagnosis;
  watched(
      [&](const std::function<bool()>& interrupted) {
        options.interrupted = interrupted;
        diagnosis = diagnose(recordings, options);
      },
      [&] {
        if (const auto now = box.take(); now && !progress.is_none()) progress(now->phase, now->done, now->expected);
      });
  return answerOf(diagnosis, diagnosedModel(recordings.front(), options.model));
}

}  // namespace

void bindDiagnosis(py::module_& module) {
  module.def("_diagnose", &diagnoseRecordings, py::arg("recordings"), py::arg("model"), py::arg("candidates"), py::arg("exclude"),
             py::arg("tune"), py::arg("smallest_gap_percent"), py::arg("max_effects"), py::arg("threads"), py::arg("seed"),
             py::arg("earlier"), py::arg("without_active_effects"), py::arg("trust_columns"), py::arg("skip_start_s"), py::arg("progress"));
}

}  // namespace musclesim::python
