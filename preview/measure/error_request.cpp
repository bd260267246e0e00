// Choosing settings by measured error. Depends on what its header names.
#include "preview/measure/error_request.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

constexpr const char *kMarch = "march", *kTruth = "reference";
constexpr unsigned kMostSamples = 64;
// Points in the medium have a noise that no number of samples takes away.
constexpr unsigned kMostTruthSamples = 2048;
// Apart from the seeds of the settings that are measured, and from each other.
constexpr unsigned kChoosingSeed = 0x43686f6fu, kMeasuringSeed = 0x4d656173u;

/// So large that about kPixels are left, and small enough to leave one.
int strideFor(const PictureRequest& whole) {
  constexpr double kPixels = 8000.0;
  const double pixels = static_cast<double>(whole.width) * whole.height;
  const int stride = static_cast<int>(std::lround(std::sqrt(pixels / kPixels)));
  return std::clamp(stride, 1, std::min(whole.width, whole.height));
}

/// Of truth: halves cancel, so that over kPixels pixels the mean square of an error is known to a hundredth
/// of the noise's square or so.
double noiseFor(double error) {
  constexpr double kNoise = 0.05, kTimesError = 2.5;
  return std::min(kNoise, kTimesError * error);
}

/// The pixels of a whole picture that a sparse one has.
Picture everyStride(const Picture& whole, int stride) {
  Picture sparse;
  sparse.width = strided(whole.width, stride);
  sparse.height = strided(whole.height, stride);
  for (size_t plane = 0; plane < whole.names.size(); ++plane) {
    sparse.add(whole.names[plane]);
    size_t to = 0;
    for (int y = stride / 2; y < whole.height; y += stride)
      for (int x = stride / 2; x < whole.width; x += stride)
        sparse.planes[plane][to++] =
            whole.planes[plane]
                        [static_cast<size_t>(y) * static_cast<size_t>(whole.width) + static_cast<size_t>(x)];
  }
  return sparse;
}

double pixelsOf(const PictureRequest& request, int stride) {
  return static_cast<double>(strided(request.width, stride)) * strided(request.height, stride);
}

bool sameButSamples(const Setting& a, const Setting& b) {
  return a.march.stepVoxels == b.march.stepVoxels && a.march.lightCache == b.march.lightCache &&
         a.march.cacheVoxels == b.march.cacheVoxels && a.march.shadowStepVoxels == b.march.shadowStepVoxels &&
         a.march.shadowGrowth == b.march.shadowGrowth;
}

}  // namespace

std::optional<int> bouncesOfTruth(const ViewedScene& view, std::optional<int> given) {
  if (given) return given;
  if (lightModelOf(view.scene, view.medium).octaveCount == 0) return 0;
  return {};
}

void requireTruth(const ViewedScene& view) {
  if (view.scene.look == Look::report)
    throw InputError({}, "--error needs a truth, and the report look has none: it is a picture by design",
                     "give a scene with look: physical by --scene");
}

std::vector<Setting> marchCandidates(const Scene& scene) {
  std::vector<Setting> settings;
  const auto add = [&](double step, bool cache, double cell, double growth) {
    Setting setting;
    setting.method = kMarch;
    setting.march = scene.march;
    setting.march.stepVoxels = step;
    setting.march.adaptive = true;
    setting.march.lightCache = cache;
    setting.march.cacheDepth = std::numeric_limits<double>::max();
    (cache ? setting.march.cacheVoxels : setting.march.shadowStepVoxels) = cell;
    if (!cache) setting.march.shadowGrowth = growth;
    settings.push_back(setting);
  };
  // Cells of the cache in voxels, then first steps towards a light and their growth.
  for (const auto& [step, cell] : {std::pair(4.0, 5.34), {2.0, 4.0}, {1.0, 2.67}, {0.5, 2.67}, {0.5, 2.0}})
    add(step, true, cell, 1.0);
  struct Marched {
    double step, shadow, growth;
  };
  for (const Marched& m : {Marched{4.0, 4.0, 1.3}, Marched{2.0, 2.0, 1.2}, Marched{1.0, 1.0, 1.15},
                           Marched{0.5, 0.5, 1.1}, Marched{0.25, 0.5, 1.05}})
    add(m.step, false, m.shadow, m.growth);
  return settings;
}

ErrorSearch::ErrorSearch(Method& march, Method& truth, const ViewedScene& view, const PictureRequest& whole,
                         double error)
    : march_(march), truth_(truth), view_(view), sparse_(whole), truthNoise_(noiseFor(error)) {
  sparse_.stride = strideFor(whole);
  sparse_.quiet = true;
  sparse_.bounces = bouncesOfTruth(view, whole.bounces);
  const double share = pixelsOf(whole, 1) / pixelsOf(whole, sparse_.stride);
  PictureRequest request = sparse_;
  request.error = truthNoise_;
  request.mostSamples = kMostTruthSamples;
  request.seed = whole.seed ^ kChoosingSeed;
  PictureCost cost;
  sparseTruth_ = truth_.render(view, request, cost);
  truthCost_ = share * cost.milliseconds * cost.relativeError * cost.relativeError;
  bool warm[2] = {false, false};  // drivers finish programs when they first draw
  for (const Setting& candidate : marchCandidates(view.scene)) {
    Picture picture = renderSparse(candidate, cost);
    const double preparing = cost.millisecondsPreparing;
    if (bool& done = warm[candidate.march.lightCache ? 1 : 0]; !done) {
      done = true;
      picture = renderSparse(candidate, cost);
    }
    const double each = share * (cost.milliseconds - cost.millisecondsPreparing);
    for (unsigned samples = 1; samples <= kMostSamples; samples *= 2) {
      ErrorRung rung{candidate, preparing + each * samples, preparing, {}};
      rung.setting.samples = samples;
      rung.setting.name = nameOf(rung.setting);
      if (samples == 1) rung.error = compareWithHalves(picture, sparseTruth_);
      rungs_.push_back(std::move(rung));
    }
  }
  if (sparse_.stride > 1) calibrate();
  std::stable_sort(rungs_.begin(), rungs_.end(),
                   [](const ErrorRung& a, const ErrorRung& b) { return a.milliseconds < b.milliseconds; });
}

void ErrorSearch::calibrate() {
  // Small pictures may not keep a machine busy: one whole picture of one sample tells by how much.
  const ErrorRung& rung = rungs_.front();
  PictureRequest whole = sparse_;
  whole.stride = 1;
  whole.samples = rung.setting.samples;
  PictureCost cost;
  march_.render(withSetting(view_, rung.setting), whole, cost);
  const double found =
      (cost.milliseconds - cost.millisecondsPreparing) / (rung.milliseconds - rung.preparing);
  for (ErrorRung& each : rungs_)
    each.milliseconds = each.preparing + found * (each.milliseconds - each.preparing);
}

Picture ErrorSearch::renderSparse(const Setting& setting, PictureCost& cost) {
  PictureRequest request = sparse_;
  request.samples = setting.samples;
  return march_.render(withSetting(view_, setting), request, cost);
}

bool ErrorSearch::canReach(const ErrorRung& rung, double error) const {
  // Evenly spread samples converge no faster than by their number; where twice as many brought less than
  // this share, what is left is no noise.
  constexpr double kStill = 0.93;
  const ErrorRung *most = nullptr, *before = nullptr;
  for (const ErrorRung& other : rungs_) {
    if (!other.error || !sameButSamples(other.setting, rung.setting)) continue;
    before = most;
    most = &other;
  }
  if (most == nullptr) return true;
  const double reached = most->error->relativeRmse;
  if (before != nullptr && reached > kStill * before->error->relativeRmse) return false;
  return reached * most->setting.samples <= error * rung.setting.samples;
}

ErrorPick ErrorSearch::pick(double error) {
  const double truthCost = truthCost_ / (error * error);
  for (ErrorRung& rung : rungs_) {
    if (rung.milliseconds >= truthCost) break;
    if (!rung.error) {
      if (!canReach(rung, error)) continue;
      PictureCost cost;
      rung.error = compareWithHalves(renderSparse(rung.setting, cost), sparseTruth_);
    }
    if (rung.error->high <= error) return {rung.setting, rung.error->high, rung.milliseconds};
  }
  ErrorPick truth;
  truth.setting.method = truth.setting.name = kTruth;
  truth.error = error;
  truth.milliseconds = truthCost;
  return truth;
}

NoisyError ErrorSearch::measure(const Picture& picture) {
  PictureRequest request = sparse_;
  request.error = truthNoise_;
  request.mostSamples = kMostTruthSamples;
  request.seed = sparse_.seed ^ kMeasuringSeed;
  PictureCost cost;
  return compareWithHalves(everyStride(picture, sparse_.stride), truth_.render(view_, request, cost));
}

size_t ErrorSearch::measuredRungs() const {
  return static_cast<size_t>(std::count_if(rungs_.begin(), rungs_.end(),
                                           [](const ErrorRung& rung) { return rung.error.has_value(); }));
}

}  // namespace nephele
