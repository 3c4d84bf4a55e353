/// Reads and changes the sidecar, the JSON file beside a recording's CSV file.
#pragma once

#include <string>
#include <vector>

#include "musclesim/log/recording_info.h"

namespace musclesim {

/// The only value that the member "format" may have.
inline constexpr const char* recording_format = "musclesim-recording-1";

/// Whether the format knows this member.
bool isSidecarMember(const std::string& name);

/// Reads a sidecar's text; `file` is used in messages only. Adds remarks for the user to `notes`.
/// Entries of noise_std that belong to a column in `ignore_columns` are skipped.
/// Throws BadFile with line and column (of the member, where a member is wrong) and what is allowed.
RecordingInfo parseSidecar(const std::string& text, const std::string& file, const std::vector<std::string>& ignore_columns,
                           std::vector<std::string>& notes);

/// Returns the sidecar with one member set or replaced; `json_value` is JSON text. Throws BadParameter if the result is not a valid
/// sidecar.
RecordingInfo withMember(const RecordingInfo& info, const std::string& member, const std::string& json_value);

}  // namespace musclesim
