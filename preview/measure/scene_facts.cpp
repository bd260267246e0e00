// Facts from bricks. Depends on what its header names.
#include "preview/measure/scene_facts.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <variant>

namespace nephele {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr uint64_t kMostLooks = 200000;
constexpr int kReach = 2;  // voxels

/// The sample at an index position; 0 outside all bricks.
double sampleAt(const BrickVolume& bricks, const ivec3& at) {
  const ivec3 from = at - kBrickCells * bricks.brickMin, n = bricks.brickCount;
  const ivec3 brick = from / kBrickCells;
  if (glm::any(glm::lessThan(from, ivec3(0))) || glm::any(glm::greaterThanEqual(brick, n))) return 0.0;
  const auto row = [](int z, int y, int edge) {
    return static_cast<size_t>(z) * static_cast<size_t>(edge) + static_cast<size_t>(y);
  };
  const uint32_t entry = bricks.index[row(0, 0, 1) + (row(brick.z, brick.y, n.y)) * static_cast<size_t>(n.x) +
                                      static_cast<size_t>(brick.x)];
  if (entry == 0) return 0.0;
  const ivec3 in = from - kBrickCells * brick;
  return double{bricks.samples[(entry - 1) * static_cast<size_t>(kBrickVolume) +
                               row(in.z, in.y, kBrickSamples) * static_cast<size_t>(kBrickSamples) +
                               static_cast<size_t>(in.x)]};
}

/// The least, or the largest, of the samples within kReach along `step` (an axis, signed).
template <class Pick>
double alongAxis(const BrickVolume& bricks, const ivec3& at, const ivec3& step, Pick&& pick) {
  double value = sampleAt(bricks, at + step);
  for (int far = 2; far <= kReach; ++far) value = pick(value, sampleAt(bricks, at + far * step));
  return value;
}

/// Axes along which a voxel is narrow.
int narrowAxes(const BrickVolume& bricks, const ivec3& at, double density) {
  const auto least = [](double a, double b) { return std::min(a, b); };
  int narrow = 0;
  for (int axis = 0; axis < 3; ++axis) {
    ivec3 step(0);
    step[axis] = 1;
    narrow += alongAxis(bricks, at, step, least) < 0.5 * density &&
                      alongAxis(bricks, at, -step, least) < 0.5 * density
                  ? 1
                  : 0;
  }
  return narrow;
}

double peakAt(const BrickVolume& bricks, const ivec3& at, double density) {
  const auto largest = [](double a, double b) { return std::max(a, b); };
  double around = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1}) {
      ivec3 step(0);
      step[axis] = sign;
      around = std::max(around, alongAxis(bricks, at, step, largest));
    }
  constexpr double kAlone = 1e9;  // beside nothing
  return std::min(kAlone, density / std::max(around, std::numeric_limits<double>::min()));
}

/// Calls look(brick) for every brick that holds density, brick in bricks from the index's first.
template <class Look>
void eachBrick(const BrickVolume& bricks, Look&& look) {
  size_t at = 0;
  for (int z = 0; z < bricks.brickCount.z; ++z)
    for (int y = 0; y < bricks.brickCount.y; ++y)
      for (int x = 0; x < bricks.brickCount.x; ++x, ++at)
        if (bricks.index[at] != 0) look(ivec3(x, y, z), size_t{bricks.index[at]} - 1);
}

/// The place of a densest sample.
ivec3 placeOfMaximum(const BrickVolume& bricks) {
  ivec3 place(0);
  double largest = -1.0;
  eachBrick(bricks, [&](const ivec3& brick, size_t slot) {
    if (!(double{bricks.slotMaximum[slot]} > largest)) return;
    largest = double{bricks.slotMaximum[slot]};
    const float* samples = bricks.samples.data() + slot * static_cast<size_t>(kBrickVolume);
    const int at = static_cast<int>(std::max_element(samples, samples + kBrickVolume) - samples);
    place =
        kBrickCells * (bricks.brickMin + brick) +
        ivec3(at % kBrickSamples, at / kBrickSamples % kBrickSamples, at / (kBrickSamples * kBrickSamples));
  });
  return place;
}

}  // namespace

BrickFacts brickFactsOf(const BrickVolume& bricks) {
  BrickFacts facts;
  if (bricks.empty()) return facts;
  uint64_t cells = 0;
  constexpr uint64_t kCellsOfBrick = uint64_t{kBrickCells} * kBrickCells * kBrickCells;
  eachBrick(bricks, [&](const ivec3&, size_t) { cells += kCellsOfBrick; });
  const uint64_t stride = cells / kMostLooks | 1;  // odd: every place in a brick has its turn
  double mass = 0.0, sheets = 0.0, sheetSquares = 0.0, grains = 0.0, grainSquares = 0.0;
  uint64_t next = 0, first = 0;
  eachBrick(bricks, [&](const ivec3& brick, size_t) {
    for (; next < first + kCellsOfBrick; next += stride) {
      const int in = static_cast<int>(next - first);
      const ivec3 at =
          kBrickCells * (bricks.brickMin + brick) +
          ivec3(in % kBrickCells, in / kBrickCells % kBrickCells, in / (kBrickCells * kBrickCells));
      const double density = sampleAt(bricks, at);
      if (!(density > 0.0)) continue;
      mass += density;
      const int narrow = narrowAxes(bricks, at, density);
      if (narrow == 0) continue;
      (narrow == 3 ? grains : sheets) += density;
      (narrow == 3 ? grainSquares : sheetSquares) += density * density;
    }
    first += kCellsOfBrick;
  });
  if (mass > 0.0) {
    facts.sheetShare = sheets / mass;
    facts.grainShare = grains / mass;
  }
  if (sheets > 0.0) facts.sheetDensity = sheetSquares / sheets;
  if (grains > 0.0) facts.grainDensity = grainSquares / grains;
  const ivec3 densest = placeOfMaximum(bricks);
  facts.peak = peakAt(bricks, densest, sampleAt(bricks, densest));
  return facts;
}

SceneFacts sceneFactsOf(const BrickFacts& facts, const BrickVolume& bricks, const ViewedScene& view) {
  SceneFacts scene;
  scene.stepVoxels = view.scene.march.stepVoxels;
  if (bricks.empty()) return scene;
  double sigma = 0.0;
  for (size_t c = 0; c < 3; ++c) sigma = std::max(sigma, view.medium.sigmaS[c] + view.medium.sigmaA[c]);
  const double voxel = sigma * voxelEdge(bricks);
  scene.voxelDepth = voxel * bricks.meanActive;
  scene.sheetShare = facts.sheetShare;
  scene.sheetDepth = voxel * facts.sheetDensity;
  scene.grainShare = facts.grainShare;
  scene.grainDepth = voxel * facts.grainDensity;
  scene.peak = facts.peak;
  const glm::dmat4 indexFromWorld = glm::inverse(bricks.worldFromIndex);
  const auto depthAt = [&](const dvec3& place) {
    return voxel * densityAt(bricks, dvec3(indexFromWorld * glm::dvec4(place, 1.0)));
  };
  scene.cameraDepth = depthAt(view.camera.position);
  for (const Light& light : view.scene.lights)
    if (const auto* point = std::get_if<PointLight>(&light))
      scene.lightDepth = std::max(scene.lightDepth, depthAt(point->position));
  return scene;
}

}  // namespace nephele
