// The bake's part of docs/stability.md: stability.csv, .svg, .png and .md. Depends on stability.h, base.
#pragma once

#include <string>

#include "bake/stability.h"
#include "base/trust_map.h"

namespace nephele {

/// Up to which error a bake is trusted: its voxels, and what stands between them.
inline constexpr double kTrustedVoxels = 1e-3, kTrustedDepths = 0.05;

/// The map's sections: one a measure, and the integrators'.
std::vector<TrustMap> trustMapsOf(const BakeStability& result);

/// The page, Markdown.
std::string bakeStabilityPage(const BakeStability& result);

/// Sentences on what no density may hold and on particles that fly away, one a cell; empty where all is well.
std::vector<std::string> badBakes(const BakeStability& result);

/// Writes the files into `folder`, which exists. Where gnuplot is missing, the sentence on it; else an empty
/// text. Throws WorldError.
std::string writeBakeStability(const std::string& folder, const BakeStability& result);

}  // namespace nephele
