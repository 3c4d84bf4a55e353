/// `musclesim blind run`: diagnoses the cases without their key.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "musclesim/log/recording.h"

namespace musclesim::blind {

struct RunOptions {
  int job_count = 0;  ///< cases at once; 0: one per core. Each is diagnosed by one thread, so that the answers are the same
  std::vector<std::string> candidates;  ///< ids of effects to consider; empty: the whole catalogue
  std::vector<std::string> leave_out;   ///< parts of the method to do without (MethodPart)
  std::string commit;                   ///< of the sources, noted with the answers; may be empty
  std::function<void(int done, int count)> progress = [](int, int) {};
  std::function<bool()> interrupted = [] { return false; };
};

struct RunSummary {
  int answered = 0;  ///< so far, earlier runs included
  int count = 0;
  int failed = 0;  ///< answers that only say why the diagnosis failed
  bool complete() const { return answered == count; }
};

/// Writes DIR/answers/caseNNN.json for every case without an answer, and DIR/answers.json when there are all: program, SHA-256 of the
/// answers, seconds per case. A case that cannot be diagnosed gets the verdict "failed" with its reason.
/// Throws BadParameter if the key is within reach, if other answers were made by another program or with other
/// candidates or another method, and for unknown candidates and parts of the method.
RunSummary run(const std::filesystem::path& folder, const RunOptions& options);

/// Throws BadParameter if the file says that it was made by another program, with other candidates or with another method than `members`.
void requireSameProgram(const std::filesystem::path& file, const nlohmann::json& members);

/// A case's recordings, named relative to DIR, so that an answer does not depend on where DIR lies.
std::vector<Recording> recordingsOf(const std::filesystem::path& folder, const std::string& name);

/// The chosen effects, as a file for `--effects`.
std::filesystem::path effectsOf(const std::filesystem::path& folder, const std::string& name);

/// The files of the answers relative to DIR, in the order of the cases.
std::vector<std::string> answerFiles(const std::filesystem::path& folder);

}  // namespace musclesim::blind
