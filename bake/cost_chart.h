// What a bake costs against how far it is from the same recipe baked finer: `nephele-bake chart`. Depends on
// pipeline, trial, volume's difference, base; no OpenVDB.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline.h"

namespace nephele {

/// One bake, measured against the reference.
struct CostPoint {
  std::string sweep;  // what was varied: "voxel size", "octaves", "precision", "cutoff"
  Asset look;
  double seconds = 0.0;  // of filling and writing
  uint64_t fileBytes = 0, gridBytes = 0, voxelsActive = 0;
  double densityLargest = 0.0, densityRms = 0.0;  // over the reference's maximum
  double depthLargest = 0.0, depthRms = 0.0;      // over the reference's largest depth
};

struct CostChart {
  std::string asset;
  std::optional<int> frame;
  double referenceSize = 0.0;  // voxel size of the reference: float, all octaves, a tenth of the cutoff
  uint64_t referenceVoxels = 0, rays = 0;
  std::vector<CostPoint> points;
  std::vector<size_t> front;  // of depthLargest over fileBytes
  size_t knee = 0;            // index into front
  std::vector<std::string> leftOut;
};

/// Bakes the asset (a sequence's middle frame) over voxel sizes round its own, octaves, precision and cutoff,
/// and holds each against a reference of half the smallest voxel size. Files are written into `folder`,
/// measured and removed. Where the reference would be too large, the finest sizes are left out and named.
/// Throws InputError or WorldError.
CostChart measureCosts(const Pipeline& pipeline, const Asset& asset, const std::string& folder, bool quiet);

/// chart.csv, chart.svg, chart.png and an index.html that stands alone. Where gnuplot is missing, the
/// sentence on it; else an empty text. Throws WorldError.
std::string writeCostChart(const std::string& folder, const CostChart& chart);

/// The front, a line a point, its knee marked.
std::string costFrontAsText(const CostChart& chart);

}  // namespace nephele
