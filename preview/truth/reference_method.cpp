// Pictures by the path tracer. Depends on preview/truth, preview/method.h, base and TBB.
#include "preview/truth/reference_method.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "preview/truth/camera.h"
#include "preview/truth/estimate.h"
#include "preview/truth/path_tracer.h"
#include "preview/truth/staged_tracer.h"
#include "scene/light_model.h"
#include "scene/sky.h"

namespace nephele {
namespace {

using namespace truth;
using Clock = std::chrono::steady_clock;

glm::vec3 vectorOf(const Rgb& rgb) { return glm::vec3(glm::dvec3(rgb[0], rgb[1], rgb[2])); }

TrackedMedium trackedMedium(const BrickVolume& bricks, const Medium& medium) {
  TrackedMedium tracked;
  tracked.bricks = &bricks;
  tracked.sigmaS = vectorOf(medium.sigmaS);
  tracked.sigmaT = tracked.sigmaS + vectorOf(medium.sigmaA);
  tracked.sigmaMax = std::max({tracked.sigmaT.x, tracked.sigmaT.y, tracked.sigmaT.z});
  tracked.grey = tracked.sigmaT == glm::vec3(tracked.sigmaMax);
  const glm::dmat3 worldFromIndex(bricks.worldFromIndex);
  tracked.worldFromIndex = glm::mat3(worldFromIndex);
  tracked.indexFromWorld = glm::mat3(glm::inverse(worldFromIndex));
  if (tracked.sigmaMax > 0.0f) tracked.grid = buildControlGrid(bricks, double{tracked.sigmaMax});
  return tracked;
}

PhaseFunction phaseOf(const ViewedScene& view) {
  const PhaseLobes lobes = lightModelOf(view.scene, view.medium).phase;
  return {static_cast<float>(lobes.first), static_cast<float>(lobes.second), static_cast<float>(lobes.share)};
}

/// The corner of the brick grid.
glm::dvec3 worldCorner(const BrickVolume& bricks) {
  return glm::dvec3(bricks.worldFromIndex * glm::dvec4(glm::dvec3(bricks.brickMin * kBrickCells), 1.0));
}

/// The environment behind the medium, where the scene asks to show it.
struct SkyBehind {
  explicit SkyBehind(const ViewedScene& viewed) : view(viewed), shown(viewed.scene.environment.show) {}
  void add(const glm::vec3& along, float share, const glm::vec3& transmittance, BlockMean& mean) const {
    const glm::dvec3 radiance =
        skyRadiance(view.scene.environment, view.environmentMap.get(), view.up, glm::dvec3(along));
    for (int c = 0; c < 3; ++c)
      mean.radiance[c] += share * transmittance[c] * static_cast<float>(radiance[c]);
  }
  const ViewedScene& view;
  bool shown;
};

/// One picture being sampled.
class Sampling {
 public:
  Sampling(const BrickVolume& bricks, const ViewedScene& view, const PictureRequest& request)
      : request_(request),
        medium_(trackedMedium(bricks, view.medium)),
        lights_(view, medium_, worldCorner(bricks)),
        emitter_(Emitter::isOn(view, bricks) ? std::optional<Emitter>(std::in_place, view, bricks)
                                             : std::nullopt),
        stage_(view.scene.stage.on ? std::optional<StageSurfaces>(std::in_place, view, bricks)
                                   : std::nullopt),
        tracer_(medium_, phaseOf(view), lights_, {request.bounces.value_or(-1), true},
                emitter_ ? &*emitter_ : nullptr, stage_ ? &*stage_ : nullptr),
        rays_(view.camera, bricks, request.width, request.height),
        camera_(view.camera.position),
        sky_(view),
        width_(strided(request.width, request.stride)),
        height_(strided(request.height, request.stride)),
        estimate_(width_, height_) {}

  /// Adds blocks of `size` samples to each pixel until it has as many as `until` says.
  void add(const std::vector<unsigned>& until, unsigned size) {
    constexpr int kTile = 16;  // neighbours share what lies in the caches
    const tbb::blocked_range2d<int> all(0, height_, kTile, 0, width_, kTile);
    Progress progress("tracing", pixels(), request_.quiet);
    tbb::parallel_for(all, [&](const tbb::blocked_range2d<int>& tile) {
      uint64_t looks = 0, paths = 0;
      for (int y = tile.rows().begin(); y != tile.rows().end(); ++y)
        for (int x = tile.cols().begin(); x != tile.cols().end(); ++x)
          for (const size_t at = traced(x, y); estimate_.blocksOf(at) < until[at]; paths += size)
            addBlock(x, y, size, looks);
      looks_ += looks;
      paths_ += paths;
      progress.advance(tile.rows().size() * tile.cols().size());
    });
  }
  void add(unsigned until, unsigned size) { add(std::vector<unsigned>(pixels(), until), size); }

  const Estimate& estimate() const { return estimate_; }
  uint64_t looks() const { return looks_; }
  double pathsPerPixel() const { return static_cast<double>(paths_) / static_cast<double>(pixels()); }
  size_t pixels() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }

 private:
  /// The number of a pixel among those that are traced.
  size_t traced(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(width_) + static_cast<size_t>(column);
  }

  /// `column` and `row` are of the pixels that are traced. Random numbers are those of the whole picture.
  void addBlock(int column, int row, unsigned size, uint64_t& looks) {
    const int x = column * request_.stride + request_.stride / 2,
              y = row * request_.stride + request_.stride / 2;
    const size_t pixel =
        static_cast<size_t>(y) * static_cast<size_t>(request_.width) + static_cast<size_t>(x);
    const uint64_t seed = seedOf(request_.seed, pixel, estimate_.blocksOf(traced(column, row)));
    BlockMean mean;
    const float share = 1.0f / static_cast<float>(size);
    for (unsigned i = 0; i < size; ++i) {
      const double atX = x + double{stratified(0, i, seed)}, atY = y + double{stratified(1, i, seed)};
      if (stage_) {
        addStaged(rays_.along(atX, atY), {i, seed}, share, mean, looks);
        continue;
      }
      const auto entering = rays_.at(atX, atY);
      if (!entering) {
        if (sky_.shown) sky_.add(glm::vec3(rays_.along(atX, atY)), share, glm::vec3(1.0f), mean);
        continue;
      }
      Random random(seedOf(seed, i));
      const PathSample sample = tracer_.trace(entering->ray, entering->along, {i, seed}, random, looks);
      for (int c = 0; c < 3; ++c) {
        mean.radiance[c] += share * sample.radiance[c];
        mean.transmittance[c] -= share * (1.0f - sample.transmittance[c]);
      }
      if (sky_.shown) sky_.add(entering->along, share, sample.transmittance, mean);
      mean.taken += share * sample.taken;
      mean.takenDistance += share * sample.taken * (static_cast<float>(entering->before) + sample.distance);
    }
    estimate_.add(traced(column, row), mean);
  }

  void addStaged(const glm::dvec3& along, const StratifiedPoint& point, float share, BlockMean& mean,
                 uint64_t& looks) {
    Random random(seedOf(point.seed, point.number));
    const StagedTracer staged(*stage_, rays_, tracer_, medium_, lights_);
    const StagedSample sample = staged.trace(camera_, along, point, random, looks);
    for (int c = 0; c < 3; ++c) {
      mean.radiance[c] += share * sample.radiance[c];
      mean.transmittance[c] -= share * (1.0f - sample.transmittance[c]);
    }
    if (sky_.shown) sky_.add(glm::vec3(along), share, sample.transmittance, mean);
    mean.taken += share * sample.taken;
    mean.takenDistance += share * sample.takenDistance;
  }

  const PictureRequest& request_;
  TrackedMedium medium_;
  LightSources lights_;
  std::optional<Emitter> emitter_;
  std::optional<StageSurfaces> stage_;
  PathTracer tracer_;
  CameraRays rays_;
  glm::dvec3 camera_;
  SkyBehind sky_;
  int width_, height_;
  Estimate estimate_;
  std::atomic<uint64_t> looks_{0}, paths_{0};
};

/// Samples of a block: as many as leave `kBlocks` of them, since points of one block are spread evenly and
/// blocks tell the noise.
unsigned blockSize(unsigned samples) {
  constexpr unsigned kBlocks = 4, kLargest = 64;
  return std::clamp(std::bit_floor(samples / kBlocks), 1u, kLargest);
}

/// Samples until the picture's noise is surely at most `error`, or pixels have `mostSamples` on average.
/// After the first blocks pixels get more of them the noisier their neighbourhood is.
void sampleUntil(Sampling& sampling, double error, unsigned size, unsigned mostSamples) {
  constexpr unsigned kFirst = 8;       // fewer tell the noise badly
  constexpr double kAtOnce = 2.0;      // grow by at most this factor between two looks at the noise
  constexpr double kMargin = 1.02;     // rather a little too far than once more
  constexpr float kLeastShare = 0.2f;  // of the mean: what the first blocks did not find is found yet
  sampling.add(kFirst, size);
  const std::vector<float> shares = sampling.estimate().shares(kLeastShare);
  for (double blocks = kFirst;;) {  // on average
    const double reached = sampling.estimate().relativeErrorBound();
    if (reached <= error || (mostSamples > 0 && blocks * size >= mostSamples)) return;
    blocks *= std::min(kAtOnce, kMargin * reached * reached / (error * error));
    std::vector<unsigned> until(shares.size());
    for (size_t i = 0; i < until.size(); ++i)  // even numbers, since there are two halves
      until[i] = std::max(kFirst, 2 * static_cast<unsigned>(std::ceil(0.5 * blocks * double{shares[i]})));
    sampling.add(until, size);
  }
}

/// Nothing but what stands behind, seen through the pixels' centres.
Picture emptyPicture(const ViewedScene& view, const PictureRequest& request) {
  constexpr unsigned kBlocks = 2;  // so that there are halves
  const int width = strided(request.width, request.stride), height = strided(request.height, request.stride);
  const SkyBehind sky(view);
  const CameraRays rays(view.camera, BrickVolume{}, request.width, request.height);
  const auto centre = [&](int at) { return at * request.stride + request.stride / 2 + 0.5; };
  Estimate estimate(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      BlockMean mean;
      if (sky.shown) sky.add(glm::vec3(rays.along(centre(column), centre(row))), 1.0f, glm::vec3(1.0f), mean);
      for (unsigned block = 0; block < kBlocks; ++block)
        estimate.add(static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column),
                     mean);
    }
  return estimate.picture();
}

class ReferenceMethod : public Method {
 public:
  ReferenceMethod() { renderer = "CPU"; }

  void setVolume(const BrickVolume& bricks) override { bricks_ = &bricks; }

  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    NEPHELE_CHECK_EQ(bricks_ != nullptr, true);
    const auto start = Clock::now();
    Picture picture;
    if (view.scene.stage.on && request.bounces != 0)
      throw InputError({}, "the reference renders the stage by the first order alone", "ask for --bounces 0");
    const bool medium = view.medium.sigmaS != Rgb{} || view.medium.sigmaA != Rgb{};
    if (view.scene.stage.on && (bricks_->empty() || !medium))
      throw InputError({}, "the reference renders the stage around a medium, and there is none");
    if (bricks_->empty() || !medium) {
      picture = emptyPicture(view, request);
      cost = {};
    } else {
      Sampling sampling(*bricks_, view, request);
      constexpr unsigned kBlockTowardsError = 16;
      const unsigned size = request.error > 0.0 ? kBlockTowardsError : blockSize(request.samples);
      if (request.error > 0.0)
        sampleUntil(sampling, request.error, size, request.mostSamples);
      else
        sampling.add((request.samples + size - 1) / size, size);
      picture = sampling.estimate().picture();
      cost.densitySamplesPerPixel =
          static_cast<double>(sampling.looks()) / static_cast<double>(sampling.pixels());
      cost.relativeError = sampling.estimate().relativeError();
      cost.pathsPerPixel = sampling.pathsPerPixel();
      cost.gpuBytes = 0;
    }
    cost.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return picture;
  }

 private:
  const BrickVolume* bricks_ = nullptr;
};

}  // namespace

std::unique_ptr<Method> makeReferenceMethod(const MethodOptions&) {
  return std::make_unique<ReferenceMethod>();
}

}  // namespace nephele
