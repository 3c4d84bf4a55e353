/// Reads TOML files, for parameters and sweeps.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace musclesim {

/// `file` is used in messages only. Throws BadFile with line and column if the text is not TOML.
toml::table parseToml(const std::string& text, const std::string& file);

/// The same from a file of at most 1 MiB. Throws IoError if it cannot be read.
toml::table readToml(const std::string& file);

}  // namespace musclesim
