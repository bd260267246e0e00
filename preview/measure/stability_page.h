// The stability map as files: stability.csv, .svg, .png, .md, and stability_table.inc for the warnings.
// Depends on preview/measure and base.
#pragma once

#include <string>

#include "preview/measure/stability.h"

namespace nephele {

/// Relative RMSE up to which a method is trusted at a point of an axis.
inline constexpr double kTrustedError = 0.05;

/// The page: a table for each method of error along each axis, from where to where it may be trusted, and
/// flicker. Markdown.
std::string stabilityPage(const StabilityResult& result);

/// Writes the files into `folder`, which exists; returns as writeChart does.
std::string writeStability(const std::string& folder, const StabilityResult& result);

/// Sentences on what no picture may hold, one a cell; empty where all is well.
std::vector<std::string> badCells(const StabilityResult& result);

}  // namespace nephele
