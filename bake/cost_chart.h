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
  std::string sweep;  // what was varied: "voxel size", "octaves", "precision", "density step",
                      // "cutoff"; "joint": several
  Asset look;
  double seconds = 0.0;  // of filling and writing
  uint64_t fileBytes = 0, gridBytes = 0, voxelsActive = 0;
  double densityLargest = 0.0;  // over the reference's maximum
  double densityRmse = 0.0;     // relative RMSE: over the reference's mean where either is above 0
  double depthLargest = 0.0, depthRms = 0.0;  // over the reference's largest depth
};

enum class CostKind { file, seconds, memory };
/// The largest of depths, the relative RMSE of densities: at a crisp rim one voxel always errs by all of it.
enum class CostError { depth, density };

double costOf(const CostPoint& point, CostKind kind);  // bytes or seconds
double errorOf(const CostPoint& point, CostError error);

/// The bakes that are worth their cost, by growing cost.
struct CostFront {
  CostError error = CostError::depth;
  CostKind cost = CostKind::file;
  std::vector<size_t> points;  // indices into the chart's
  size_t knee = 0;             // index into points
};

struct CostChart {
  std::string asset;
  std::optional<int> frame;
  double referenceSize = 0.0;  // voxel size of the reference: float, all octaves, a tenth of the cutoff
  uint64_t referenceVoxels = 0, rays = 0;
  std::vector<CostPoint> points;
  std::vector<CostFront> fronts;  // each error over each cost; that of depths over bytes of the file first
  std::vector<std::string> leftOut;
};

/// Bakes the asset (a sequence's middle frame) over voxel sizes round its own, octaves, precision, density
/// step and cutoff, one at a time, then those joint settings that are expected on a front, and holds each
/// against a reference of half the smallest voxel size. Files are written into `folder`, measured and
/// removed. Where the reference would be too large, the finest sizes are left out and named. Throws
/// InputError or WorldError.
CostChart measureCosts(const Pipeline& pipeline, const Asset& asset, const std::string& folder, bool quiet);

/// The fronts of the points, in the chart's order. What misses all of the depth somewhere is on none.
std::vector<CostFront> costFronts(const std::vector<CostPoint>& points);

/// Settings of several kinds at once, with what the points measured of each kind alone lets expect: those on
/// a front of measured and expected ones together, the likeliest first. The first point is what all differ
/// from.
std::vector<CostPoint> jointSettings(const std::vector<CostPoint>& points);

/// chart.csv, chart.svg, chart.png and an index.html that stands alone. Where gnuplot is missing, the
/// sentence on it; else an empty text. Throws WorldError.
std::string writeCostChart(const std::string& folder, const CostChart& chart);

/// The first front, a line a point, its knee marked; then each other front's knee.
std::string costFrontAsText(const CostChart& chart);

}  // namespace nephele
