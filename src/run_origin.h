/// What a run keeps beside its recording so that `rerun` can repeat it from its folder alone.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "run_output.h"

namespace musclesim::command_line {

/// A file that the command line names, and its copy.
struct KeptFile {
  std::string option;                  ///< "--robot"
  std::string given;                   ///< the path as it stands on the command line
  std::string hash;                    ///< of the contents
  std::optional<std::string> copy;     ///< path relative to the recording's folder; none: the file is not copied
  std::optional<std::string> sidecar;  ///< likewise, of the copy of the recording's sidecar beside it, if there is one
};

/// Member "run" of the sidecar.
struct RunOrigin {
  std::vector<std::string> arguments;  ///< without the program and the sub-command
  std::vector<KeptFile> files;
  std::map<std::string, std::string> build;  ///< programBuild()
};

/// The files that the options name; `option` and `given` alone are filled in.
std::vector<KeptFile> namedFiles(const ModelOptions& model, const RunOptions& options);

/// Copies the input files of a run into the folder STEM_inputs beside its recording, one folder per option. Plugins,
/// which may need other libraries, and devices and pipes are not copied: their hash and path are kept instead. Throws IoError.
RunOrigin keepOrigin(const ModelOptions& model, const RunOptions& options, const std::filesystem::path& csv);

nlohmann::json jsonOf(const RunOrigin& origin);
/// Reads what jsonOf wrote. Throws BadFile with the sidecar's name.
RunOrigin originFromJson(const nlohmann::json& value, const std::string& sidecar);

/// The hash of a file's contents, as in KeptFile. Throws IoError, BadFile if it is too large.
std::string hashOfFile(const std::filesystem::path& file);

/// The arguments with the copies, in `folder`, in place of the files. Throws BadFile for a copy that lies outside of the folder, has gone,
/// or is no regular file.
std::vector<std::string> argumentsWithCopies(const RunOrigin& origin, const std::filesystem::path& folder, const std::string& sidecar);

}  // namespace musclesim::command_line
