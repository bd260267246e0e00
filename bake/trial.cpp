// Bakes in memory. Depends on trial.h, voxelize, particle_run.
#include "bake/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <set>

#include "bake/particle_run.h"
#include "bake/voxelize.h"
#include "bake/voxelize_rays.h"
#include "base/figures.h"

namespace nephele {
namespace {

// Voxels so small that no noise has faded: what has faded altogether has no support.
constexpr double kNoneFaded = 1e-6;
// Voxels along the sides of the bake that finds where the density is.
constexpr double kSeenAlongLongest = 128.0, kSeenAlongShortest = 16.0;
// Blocks that may hold something in the box of that bake, sixteen times a cube's: their grid takes 128 MiB,
// however thin the box is.
constexpr double kMostBlocksToSee = 65536.0;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void raiseOctaves(const FieldSpec& spec, std::set<const FieldSpec*>& seen, int& most) {
  if (!seen.insert(&spec).second) return;
  if (const auto found = spec.values.find("octaves"); found != spec.values.end())
    most = std::max(most, int(std::get<int64_t>(found->second)));
  for (const auto& [name, children] : spec.children)
    for (const FieldSpecPtr& child : children) raiseOctaves(*child, seen, most);
}

TrialBaker::Extent extentOf(const Box& box) {
  const glm::dvec3 size = box.high - box.low;
  const double longest = std::max({size.x, size.y, size.z}), shortest = std::min({size.x, size.y, size.z});
  if (box.empty() || !std::isfinite(longest)) return {};
  return {longest, shortest};
}

/// Voxels for that bake of what lies in `box`, part of an extent.
double sizeToSee(const Box& box, const TrialBaker::Extent& extent) {
  double size = extent.longest / kSeenAlongLongest;
  if (extent.shortest > 0.0) size = std::min(size, extent.shortest / kSeenAlongShortest);
  const auto blocks = [&] {
    const double edge = size * kBlockEdge;
    const glm::dvec3 along = glm::floor(box.high / edge) - glm::floor(box.low / edge) + 1.0;
    return along.x * along.y * along.z;
  };
  while (size < extent.longest && blocks() > kMostBlocksToSee) size *= 2.0;
  return size;
}

VoxelizeSettings settingsOf(const Asset& look) {
  VoxelizeSettings settings;
  settings.voxelSize = look.voxelSize;
  settings.cutoff = look.cutoff;
  settings.half = look.precision == Precision::half;
  settings.densityStep = look.densityStep;
  return settings;
}

}  // namespace

struct TrialBaker::State {
  const Pipeline& pipeline;
  const Asset& asset;
  std::vector<std::optional<int>> frames;
  std::vector<std::unique_ptr<ParticleRun>> runs;  // one a frame, there already

  Box supportOf(size_t frame) const {
    BuildContext context = contextOf(pipeline, asset, frames[frame]);
    context.voxelSize = kNoneFaded;
    return buildField(*asset.density, context)->support();
  }

  FieldPtr fieldOf(size_t frame, const Asset& look) const {
    return buildField(*asset.density, contextOf(pipeline, look, frames[frame]));
  }

  TrialBake bakeDensity(size_t frame, const Asset& look, const std::string& file) const {
    TrialBake result;
    BuildContext context = contextOf(pipeline, look, frames[frame]);
    context.notes = &result.notes;
    const auto start = std::chrono::steady_clock::now();
    const FieldPtr field = buildField(*asset.density, context);
    try {
      const Voxelized voxelized = voxelize(*field, settingsOf(look));
      if (!file.empty()) result.fileBytes = writeDensity(file, voxelized, Provenance{});
      result.seconds = secondsSince(start);
      result.voxelsActive = voxelized.voxelsActive;
      result.maximum = voxelized.maximum;
      result.gridBytes = voxelized.gridBytes;
      result.bricks = bricksOf(voxelized);
    } catch (const VoxelizeError& error) {
      throw InputError(asset.where, "asset '" + asset.name + "': " + error.what());
    }
    return result;
  }

  TrialBake bakeParticles(size_t frame, const Asset& look, const std::string& file) const {
    TrialBake result;
    const auto start = std::chrono::steady_clock::now();
    const Splatted splatted = runs[frame]->splatted(look);
    if (!file.empty()) result.fileBytes = writeSplatted(file, splatted, Provenance{});
    result.seconds = secondsSince(start);
    result.voxelsActive = splatted.voxelsActive;
    result.maximum = splatted.maximum;
    result.gridBytes = splatted.gridBytes;
    result.bricks = bricksOf(splatted);
    return result;
  }
};

TrialBaker::TrialBaker(const Pipeline& pipeline, const Asset& asset, std::vector<std::optional<int>> frames,
                       const std::string& outFolder)
    : state_(new State{pipeline, asset, std::move(frames), {}}) {
  if (!asset.particles) return;
  for (const std::optional<int>& frame : state_->frames) {
    state_->runs.push_back(std::make_unique<ParticleRun>(pipeline, asset, outFolder));
    state_->runs.back()->moveTo(frame);
  }
}

TrialBaker::~TrialBaker() = default;

size_t TrialBaker::frameCount() const { return state_->frames.size(); }

TrialBake TrialBaker::bake(size_t frame, const Asset& look, const std::string& file) const {
  return state_->asset.particles ? state_->bakeParticles(frame, look, file)
                                 : state_->bakeDensity(frame, look, file);
}

Chords TrialBaker::chords(size_t frame, uint64_t count, uint64_t seed) const {
  Box box = nothing();
  if (state_->asset.particles) {
    box = state_->runs[frame]->extent();
  } else {
    Asset coarse = state_->asset;
    const Box support = state_->supportOf(frame);
    coarse.voxelSize = sizeToSee(support, extent());
    coarse.precision = Precision::single;
    const BrickVolume seen = bake(frame, coarse).bricks;
    box = {glm::dvec3(seen.activeMin - 1) * coarse.voxelSize, glm::dvec3(seen.activeMax) * coarse.voxelSize};
    if (seen.empty()) box = support;  // thinner than can be seen
  }
  return randomChords(box.low, box.high, count, seed);
}

TrialBaker::Depths TrialBaker::depths(size_t frame, const Asset& look, const Chords& chords) const {
  const double voxel = look.voxelSize * look.voxelSize * look.voxelSize;
  if (state_->asset.particles) {
    BrickVolume bricks;
    double maximum = 0.0, inside = 0.0;
    {
      // Let go of before rays go through the bricks.
      const Splatted splatted = state_->runs[frame]->densityAlong(chords.lines, look);
      try {
        bricks = bricksOf(splatted);
      } catch (const InputError& error) {
        throw InputError(state_->asset.where,
                         "asset '" + state_->asset.name + "': voxels of " + number(look.voxelSize, 3) +
                             " are too small for it to be measured: " + error.diagnostics().front().sentence,
                         "give 'voxel_size', a tolerance that is less strict, or larger particles");
      }
      maximum = splatted.maximum;
    }
    std::vector<double> depths = depthsAlong(bricks, chords.lines, &inside);
    return {std::move(depths), chords.volumeOf(inside) / voxel, maximum};
  }
  const Asset& asset = state_->asset;
  try {
    RayDepths found = depthsAlong(*state_->fieldOf(frame, look), settingsOf(look), chords.lines);
    return {std::move(found.depths), chords.volumeOf(found.lengthVaried) / voxel, found.maximum};
  } catch (const VoxelizeError& error) {
    throw InputError(asset.where, "asset '" + asset.name + "': " + error.what());
  }
}

TrialBaker::Extent TrialBaker::extent() const {
  Box all = nothing();
  for (size_t n = 0; n < frameCount(); ++n) {
    if (state_->asset.particles) {
      all = hull(all, state_->runs[n]->extent());
      continue;
    }
    all = hull(all, state_->supportOf(n));
  }
  return extentOf(all);
}

std::vector<std::optional<int>> sampledFrames(const Asset& asset) {
  if (!asset.frames) return {std::nullopt};
  const int first = asset.frames->first, last = asset.frames->last;
  std::vector<std::optional<int>> frames;
  for (const int frame : {first, first + (last - first) / 2, last})
    if (frames.empty() || *frames.back() != frame) frames.emplace_back(frame);
  return frames;
}

int largestOctaves(const Asset& asset) {
  int most = 0;
  std::set<const FieldSpec*> seen;
  if (asset.density) raiseOctaves(*asset.density, seen, most);
  return most;
}

}  // namespace nephele
