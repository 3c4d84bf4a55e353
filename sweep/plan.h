/// Plans: TOML files that define the runs of a sweep.
///
///     format = "musclesim-sweep-1"
///     command = ["run", "--simple", "--robot", "rig", "--seed", "{seed}", "--out", "{out}", "--json", "--quiet"]
///     seed = 7                 # seed of all random choices here; default 1
///     files = ["recording"]    # parameters whose values are files, relative to this one; they are copied into the sweep
///     columns, result_file, row_time_limit_s: see Sweep
///     [constants]              # the same in every row
///     [grid]                   # every combination of the lists' values
///     [list]                   # lists of equal length, combined entry by entry
///     [latin_hypercube]        # count = 100; name = {low = 1, high = 5}, also with log = true or integer = true
///     [random]                 # the same, but drawn independently; also name = {choices = ["a", "b"]}
///     [repeats]                # count = 5: every row five times, with the seeds seed, seed + 1, ...
///
/// The rows are all combinations of the sections. `seed` and `repeat` are parameters of every row.
#pragma once

#include <string>

#include "sweep/sweep.h"

namespace musclesim {

/// Reads a plan and draws its random values. Copies the files that rows read into `folder`, into which writeSweep will write the sweep.
/// Throws BadFile with file, line and column; IoError.
Sweep readPlan(const std::string& file, const std::string& folder);

/// Like readPlan, from text, for plans without files: with an empty `folder`, `files` is an error.
Sweep parsePlan(const std::string& text, const std::string& file, const std::string& folder = "");

}  // namespace musclesim
