// Rays, lights and medium for the march. Depends on scene, volume/bricks.h and shaders/shared.
#include "preview/gpu/camera_rays.h"

#include "base/error.h"
#include "preview/gpu/light_parameters.h"
#include "preview/gpu/stage_parameters.h"

#include <cmath>
#include <glm/matrix.hpp>
#include <limits>

namespace nephele {
namespace {

using glm::dmat3;
using glm::dvec3;
using glm::vec4;

static_assert(kMostLights == size_t{shared::kMaxLights});

vec4 row(const dvec3& v, double w = 0.0) { return vec4(glm::vec3(v), static_cast<float>(w)); }
dvec3 vectorOf(const Rgb& rgb) { return dvec3(rgb[0], rgb[1], rgb[2]); }

/// Voxels of the finest level along one of the frame's.
double scaleOf(const IndexFrame& frame) { return std::ldexp(1.0, frame.level); }

struct Frame {
  dvec3 forward, right, up;
};

Frame frameOf(const Camera& camera) {
  const dvec3 view = camera.target - camera.position;
  const double distance = glm::length(view);
  if (!(distance > 0.0)) throw InputError({}, "the camera's target is its position, so it looks nowhere");
  const dvec3 forward = view / distance;
  const dvec3 side = glm::cross(forward, camera.up);
  // The sine of the angle between view and up, times up's length.
  constexpr double kParallel = 1e-9;
  if (!(glm::length(side) > kParallel * glm::length(camera.up)))
    throw InputError({}, "the camera's up points along its view");
  const dvec3 right = glm::normalize(side);
  return {forward, right, glm::cross(right, forward)};
}

/// Axis distance from the camera to the nearest corner of the support; 0 where the camera is beside or inside
/// it.
double planeDistance(const BrickVolume& bricks, const IndexFrame& frame, const Camera& camera,
                     const dvec3& forward) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1) != 0 ? frame.boxMax[axis] : frame.boxMin[axis];
    const dvec3 world(bricks.worldFromIndex * glm::dvec4(scaleOf(frame) * index, 1.0));
    nearest = std::min(nearest, glm::dot(world - camera.position, forward));
  }
  return std::max(nearest, 0.0);
}

void setRays(shared::MarchParameters& p, const Camera& camera, const BrickVolume& bricks,
             const IndexFrame& index, const dmat3& indexFromWorld, int width, int height) {
  const Frame frame = frameOf(camera);
  const double half = std::tan(0.5 * camera.fov);
  const double aspect = static_cast<double>(width) / height;
  const dvec3 corner = frame.forward - half * aspect * frame.right + half * frame.up;
  const dvec3 dx = (2.0 * half * aspect / width) * frame.right;
  const dvec3 dy = (-2.0 * half / height) * frame.up;
  const double distance = planeDistance(bricks, index, camera, frame.forward);
  const dvec3 brickCorner(index.brickMin * kBrickCells);
  const dvec3 cameraIndex =
      indexFromWorld * (camera.position - dvec3(bricks.worldFromIndex[3])) - brickCorner;
  p.rayCorner = row(corner);
  p.rayDx = row(dx);
  p.rayDy = row(dy);
  p.directionCorner = row(indexFromWorld * corner);
  p.directionDx = row(indexFromWorld * dx);
  p.directionDy = row(indexFromWorld * dy);
  p.originCorner = row(cameraIndex + distance * (indexFromWorld * corner), distance);
  p.originDx = row(distance * (indexFromWorld * dx));
  p.originDy = row(distance * (indexFromWorld * dy));
}

void setLights(shared::MarchParameters& p, const std::vector<Light>& lights, const BrickVolume& bricks,
               const IndexFrame& frame, const dmat3& indexFromWorld) {
  if (lights.size() > static_cast<size_t>(shared::kMaxLights))
    throw InputError({}, "the scene has " + std::to_string(lights.size()) + " lights; at most " +
                             std::to_string(shared::kMaxLights) + " are lit");
  p.counts.x = static_cast<int>(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    shared::LightParameters& to = p.lights[i];
    if (const Sun* sun = std::get_if<Sun>(&lights[i])) {
      const dvec3 toLight = glm::normalize(sun->toLight);
      to = {row(toLight, shared::kLightSun), row(indexFromWorld * toLight), row(vectorOf(sun->irradiance))};
    } else {
      const PointLight& point = std::get<PointLight>(lights[i]);
      const dvec3 index = indexFromWorld * (point.position - dvec3(bricks.worldFromIndex[3]));
      to = {row(dvec3(0.0), shared::kLightPoint), row(index - dvec3(frame.brickMin * kBrickCells)),
            row(vectorOf(point.intensity))};
    }
  }
}

/// Optical depth of one of the frame's voxels of that density.
double voxelDepth(double density, const BrickVolume& bricks, const IndexFrame& frame, double sigmaMax) {
  return sigmaMax * density * scaleOf(frame) * voxelEdge(bricks);
}

/// How many of the frame's voxels count as one: more than 1 where they cover less than the scene's
/// step_pixels.
double voxelsCounted(const ViewedScene& view, const BrickVolume& bricks, const IndexFrame& frame,
                     int height) {
  if (bricks.empty()) return 1.0;
  const Resolution asked = resolutionOf(view.camera, bricks, height, view.scene.march.stepPixels);
  const dvec3 low(bricks.activeMin - 1), high(bricks.activeMax);
  return std::max(1.0, voxelsAcross(asked, bricks.worldFromIndex, low, high) / scaleOf(frame));
}

/// How steps follow the optical depth.
void setWalk(shared::MarchParameters& p, const MarchSettings& march, const IndexFrame& frame) {
  const dvec3 cells(frame.brickCount * kBrickCells);
  // A float's last place at the far end of the index, a few times over, and never less than can matter.
  constexpr double kLeastMargin = 1e-4, kFloatStep = 1e-6;
  const double margin = std::max(kLeastMargin, kFloatStep * std::max({cells.x, cells.y, cells.z}));
  // What a step that is longer than the setting's may take of the view, and what that may vary by.
  constexpr double kStepDepth = 0.35, kStepVariation = 0.05;
  constexpr float kOfTheLayout = 0.0f;  // describeLayout() sets it
  p.walk = vec4(static_cast<float>(margin), kOfTheLayout,
                march.adaptive ? static_cast<float>(kStepDepth) : 0.0f, static_cast<float>(kStepVariation));
}

/// What the light cache holds. `counted`: see voxelsCounted.
void setCache(shared::MarchParameters& p, const MarchSettings& march, const BrickVolume& bricks,
              const IndexFrame& frame, double counted) {
  const bool open = p.octaves.w > 0.0f && p.counts.y > 0;  // how open a place is, is asked of nothing else
  // The chord costs nothing to begin with.
  const bool lights = march.lightCache && p.chordRadii.w == 0.0f;
  if (bricks.empty() || !(lights || open)) return;
  // By powers of two: between them a camera that moves needs no other cache.
  constexpr double kRounding = 1e-9;
  const double wider = std::exp2(std::floor(std::log2(counted) + kRounding));
  p.shadow.w = static_cast<float>(wider);
  constexpr double kBlock = kBlockBricks * kBrickCells;
  const float sigmaMax = std::max(p.sigmaT.x, std::max(p.sigmaT.y, p.sigmaT.z));
  const double depth = voxelDepth(bricks.meanActive, bricks, frame, double{sigmaMax});
  const double densest = voxelDepth(bricks.maximum, bricks, frame, double{sigmaMax});
  // Where light hardly falls over a cell, of the mean density and of the densest, which shades its neighbours
  // most, the way to the samples need not be marched; they may lie as far apart as the densest allows, at
  // most a brick, so that a block's fall of light is not taken for a straight one.
  constexpr double kMeanCell = 0.06, kDensestCell = 0.25;
  const double least = std::min(wider * march.cacheVoxels, kBlock);
  // 0: the mean density is not known.
  const bool isThin = depth > 0.0 && depth * least <= kMeanCell && densest * least <= kDensestCell;
  const double widest = std::min(std::max(least, wider * kBrickCells), kBlock);
  const double cell = isThin ? std::min(kDensestCell / densest, widest) : least;
  // Openness falls over a free way, however few pixels show it: factors hold where its samples stay.
  const double skyVoxels =
      open ? std::max(1.0, march.skyCacheVoxels / scaleOf(frame)) : wider * march.skyCacheVoxels;
  const double skyCell = std::min(skyVoxels, kBlock);
  const auto samples = [](double spacing) {
    return 1 + std::max(1, static_cast<int>(std::lround(kBlock / spacing)));
  };
  // Between samples the cache mixes 1/(1 + κ column), which keeps columns of any depth. With a small κ places
  // just inside a cloud come out too dark, with a large one too bright; in between they are right on the
  // mean.
  constexpr float kMixedBy = 0.5f;
  const bool good = wider * depth <= march.cacheDepth;
  const bool cached = lights && (good || march.alwaysCached);
  if (cached)
    p.cache = vec4(good ? shared::kColumnsInHalves : shared::kColumnsInBytes, kMixedBy * sigmaMax,
                   static_cast<float>(march.cacheNearVoxels),
                   isThin ? 0.0f : static_cast<float>(march.cacheNearSteps));
  constexpr float kGrowth = 1.2f, kSkyGrowth = 1.5f;
  p.cacheSteps = vec4(static_cast<float>(0.5 * cell), kGrowth, static_cast<float>(0.5 * skyCell), kSkyGrowth);
  // A picture's small suns fall between the few directions that are kept.
  const int kind = static_cast<int>(p.skyUp.w);
  const bool sky = cached && (kind == shared::kSkyConstant || kind == shared::kSkyRamp);
  p.skySize.z = open ? shared::kOpenParts : sky ? shared::kSkyParts : 0;
  p.skySize.w = sky ? 1 : 0;
  p.cacheShape = glm::ivec4(samples(cell), sky || open ? samples(skyCell) : 0, 0, 0);
}

}  // namespace

dvec3 viewDirection(const Camera& camera, int width, int height, double x, double y) {
  const Frame frame = frameOf(camera);
  const double pixel = 2.0 * std::tan(0.5 * camera.fov) / height;
  return glm::normalize(frame.forward + pixel * (x - 0.5 * width) * frame.right +
                        pixel * (0.5 * height - y) * frame.up);
}

shared::MarchParameters marchParameters(const ViewedScene& view, const BrickVolume& bricks, int width,
                                        int height, unsigned seed, bool randomStart) {
  return marchParameters(view, bricks, frameOf(bricks), width, height, seed, randomStart);
}

Resolution resolutionOf(const Camera& camera, const BrickVolume& bricks, int height, double pixels) {
  const dvec3 eye =
      glm::inverse(dmat3(bricks.worldFromIndex)) * (camera.position - dvec3(bricks.worldFromIndex[3]));
  return {eye, 0.5 * height / std::tan(0.5 * camera.fov), pixels};
}

shared::MarchParameters marchParameters(const ViewedScene& view, const BrickVolume& bricks,
                                        const IndexFrame& frame, int width, int height, unsigned seed,
                                        bool randomStart) {
  shared::MarchParameters p{};
  const dmat3 worldFromIndex = scaleOf(frame) * dmat3(bricks.worldFromIndex);
  const dmat3 indexFromWorld = glm::inverse(worldFromIndex);
  setRays(p, view.camera, bricks, frame, indexFromWorld, width, height);
  setLights(p, view.scene.lights, bricks, frame, indexFromWorld);
  p.worldFromIndexX = row(worldFromIndex[0]);
  p.worldFromIndexY = row(worldFromIndex[1]);
  p.worldFromIndexZ = row(worldFromIndex[2]);
  p.indexFromWorldX = row(indexFromWorld[0]);
  p.indexFromWorldY = row(indexFromWorld[1]);
  p.indexFromWorldZ = row(indexFromWorld[2]);
  const glm::ivec3 brickCorner = frame.brickMin * kBrickCells;
  p.boxMin = row(dvec3(frame.boxMin - brickCorner));
  p.boxMax = row(dvec3(frame.boxMax - brickCorner));
  if (bricks.empty()) p.boxMin = p.boxMax = vec4(0.0f);  // a box that no ray meets
  const Scene& scene = view.scene;
  const double counted = voxelsCounted(view, bricks, frame, height);
  p.sigmaS.w = static_cast<float>(scene.march.stepVoxels);
  p.environment.w = static_cast<float>(scene.march.giveUp);
  setLightParameters(p, view, bricks, frame);
  setStage(p, view, bricks, frame);
  // Products with steps and coefficients must stay floats, and columns below the march's own infinity.
  constexpr double kLargestDensity = 1e15;
  if (bricks.maximum > kLargestDensity)
    throw InputError({bricks.path}, "holds densities above 1e15, more than the march computes with");
  NEPHELE_CHECK_GT(scene.march.shadowStepVoxels, 0.0);
  NEPHELE_CHECK_LE(1.0, scene.march.shadowGrowth);  // less would never arrive
  p.shadow = row(dvec3(scene.march.shadowStepVoxels, scene.march.shadowGrowth, counted), counted);
  setWalk(p, scene.march, frame);
  setCache(p, scene.march, bricks, frame, counted);
  p.counts.w = randomStart ? 1 : 0;
  p.blockCount.w = scene.march.checkSkips ? 1 : 0;
  p.brickCount = glm::ivec4(frame.brickCount, static_cast<int>(seed));
  return p;
}

}  // namespace nephele
