/// Plans: a TOML file that says which runs a sweep has.
///
///     format = "musclesim-sweep-1"
///     command = ["run", "--simple", "--robot", "rig", "--seed", "{seed}", "--out", "{out}", "--json", "--quiet"]
///     seed = 7                 # of everything drawn here; default 1
///     files = ["recording"]    # parameters whose values are files, relative to this one; they are copied into the sweep
///     columns, result_file, row_time_limit_s: see Sweep
///     [constants]              # the same in every row
///     [grid]                   # every combination of the lists' values
///     [list]                   # lists of one length, taken row by row
///     [latin_hypercube]        # count = 100; name = {low = 1, high = 5}, also with log = true or integer = true
///     [random]                 # the same, drawn independently; also name = {choices = ["a", "b"]}
///     [repeats]                # count = 5: every row so many times, with the seeds seed, seed + 1, ...
///
/// The rows are all combinations of the sections. `seed` and `repeat` are parameters of every row.
#pragma once

#include <string>

#include "sweep/sweep.h"

namespace musclesim {

/// Reads a plan and draws what is random. Copies the files that rows read into `folder`, where writeSweep is to write the result.
/// Throws BadFile with file, line and column; IoError.
Sweep readPlan(const std::string& file, const std::string& folder);

/// The same from text, for plans without files: `folder` empty makes `files` an error.
Sweep parsePlan(const std::string& text, const std::string& file, const std::string& folder = "");

}  // namespace musclesim
