// The sweep behind `nephele-bake chart`. Depends on cost_chart.h, trial.h, choice.h, volume/difference.h.
#include "bake/cost_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "bake/choice.h"
#include "bake/trial.h"
#include "base/density_step.h"
#include "base/progress.h"
#include "volume/difference.h"

namespace nephele {
namespace {

// Voxels of a reference: comparing it with a bake then takes seconds.
constexpr double kMostReferenceVoxels = 2.5e7;
// Sizes that are swept, from four times the asset's own down to it, in steps of √2.
constexpr int kSizeSteps = 5;
constexpr double kReferenceCutoff = 0.1;  // of the asset's
constexpr double kCutoffs[] = {0.1, 10.0, 100.0};
// Levels that steps cut densities into, up to the largest.
constexpr double kLevels[] = {256.0, 64.0, 16.0};
constexpr uint64_t kRays = 10000;
// Joint settings that are measured: as many as are likeliest to be on a front.
constexpr size_t kMostJoint = 16;

class CostSweep {
 public:
  CostSweep(const Pipeline& pipeline, const Asset& asset, const std::string& folder, bool quiet)
      : asset_(asset), frame_(middleOf(asset)), baker_(pipeline, asset, {frame_}, folder), quiet_(quiet) {
    // Beside the files to be, under a name that nobody takes for a grid.
    file_ = (std::filesystem::path(folder) / (".chart." + asset.name + ".trial")).string();
    chart_.asset = asset.name;
    chart_.frame = frame_;
    chart_.rays = kRays;
  }

  CostChart run() {
    const double finest = findReference();
    const std::vector<std::pair<std::string, Asset>> looks = looksFrom(finest);
    Progress bar("chart", looks.size(), quiet_);
    for (const auto& [sweep, look] : looks) {
      measure(sweep, look);
      bar.advance(1);
    }
    measureJoint();
    chart_.fronts = costFronts(chart_.points);
    return std::move(chart_);
  }

 private:
  static std::optional<int> middleOf(const Asset& asset) {
    const auto frames = sampledFrames(asset);
    return frames[frames.size() / 2];
  }

  Asset ofSize(double size) const {
    Asset look = asset_;
    look.voxelSize = size;
    look.mostOctaves = kAllOctaves;
    return look;
  }

  /// As exact as can be stored.
  Asset exactOf(double size, double cutoff) const {
    Asset look = ofSize(size);
    look.precision = Precision::single;
    look.densityStep = 0.0;
    look.cutoff = cutoff;
    return look;
  }

  /// Bakes the reference at half the finest size that fits, and returns that size.
  double findReference() {
    double finest = asset_.voxelSize;
    // Four times as coarse as asked tells how many voxels there will be.
    constexpr double kProbe = 4.0;
    const double active = double(baker_.bake(0, exactOf(kProbe * finest, asset_.cutoff)).voxelsActive);
    const double perReference = active * std::pow(2.0 * kProbe, 3.0);
    const double shrink = std::cbrt(std::max(1.0, perReference / kMostReferenceVoxels));
    if (shrink > 1.0) {
      finest *= shrink;
      char text[160];
      std::snprintf(text, sizeof text,
                    "voxel sizes from %.4g to %.4g: their reference would hold more than %.3g voxels",
                    asset_.voxelSize, finest, kMostReferenceVoxels);
      chart_.leftOut.push_back(text);
    }
    chart_.referenceSize = 0.5 * finest;
    TrialBake bake = baker_.bake(0, exactOf(chart_.referenceSize, kReferenceCutoff * asset_.cutoff));
    chart_.referenceVoxels = bake.voxelsActive;
    largest_ = bake.maximum;
    reference_ = std::move(bake.bricks);
    return finest;
  }

  std::vector<std::pair<std::string, Asset>> looksFrom(double finest) const {
    std::vector<std::pair<std::string, Asset>> looks;
    const auto add = [&](const char* sweep, const Asset& from) -> Asset& {
      return looks.emplace_back(sweep, from).second;
    };
    const auto sizeOf = [&](int n) { return finest * std::pow(std::numbers::sqrt2, n); };
    for (int n = 0; n < kSizeSteps; ++n) add("voxel size", ofSize(sizeOf(n)));
    for (int most = largestOctaves(asset_) - 1; most >= 1; --most)
      add("octaves", ofSize(finest)).mostOctaves = most;
    const Precision other = asset_.precision == Precision::half ? Precision::single : Precision::half;
    for (int n = 0; n < kSizeSteps; n += 2) add("precision", ofSize(sizeOf(n))).precision = other;
    if (largest_ > 0.0)
      for (const double levels : kLevels)
        add("density step", ofSize(finest)).densityStep = densityStepFor(largest_, levels);
    for (const double factor : kCutoffs) add("cutoff", ofSize(finest)).cutoff = factor * asset_.cutoff;
    return looks;
  }

  void measureJoint() {
    std::vector<CostPoint> joint = jointSettings(chart_.points);
    if (joint.size() > kMostJoint) {
      chart_.leftOut.push_back(std::to_string(joint.size() - kMostJoint) +
                               " joint settings that are less likely to be worth their cost");
      joint.resize(kMostJoint);
    }
    Progress bar("joint", joint.size(), quiet_);
    for (const CostPoint& expected : joint) {
      measure(expected.sweep, expected.look);
      bar.advance(1);
    }
  }

  void measure(const std::string& sweep, const Asset& look) {
    TrialBake bake;
    try {
      bake = baker_.bake(0, look, file_);
    } catch (const InputError& error) {
      chart_.leftOut.push_back(sweep + ": " + error.diagnostics().front().sentence);
      return;
    }
    std::filesystem::remove(file_);
    const GridDifference d = difference(reference_, bake.bricks, kRays);
    const double maximum = d.maximumA > 0.0 ? d.maximumA : 1.0, mean = d.meanA > 0.0 ? d.meanA : 1.0,
                 depth = d.largestDepthA > 0.0 ? d.largestDepthA : 1.0;
    chart_.points.push_back({sweep, look, bake.seconds, bake.fileBytes, bake.gridBytes, bake.voxelsActive,
                             d.largest / maximum, d.rms / mean, d.largestDepth / depth, d.rmsDepth / depth});
  }

  const Asset& asset_;
  const std::optional<int> frame_;
  const TrialBaker baker_;
  const bool quiet_;
  std::string file_;
  BrickVolume reference_;
  double largest_ = 0.0;  // density of the reference
  CostChart chart_;
};

}  // namespace

CostChart measureCosts(const Pipeline& pipeline, const Asset& asset, const std::string& folder, bool quiet) {
  if (!asset.tolerance) return CostSweep(pipeline, asset, folder, quiet).run();
  const Asset chosen = chooseFor(pipeline, asset, folder).asset;
  return CostSweep(pipeline, chosen, folder, quiet).run();
}

}  // namespace nephele
