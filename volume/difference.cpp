// How far one density is from another. Depends on bricks.h, base, TBB.
#include "volume/difference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <nlohmann/json.hpp>

namespace nephele {
namespace {

using glm::dvec3;
using glm::dvec4;
using glm::ivec3;

/// Sums over one brick; added up in a fixed order.
struct Sums {
  uint64_t both = 0, onlyFirst = 0, onlySecond = 0;
  double largest = 0.0, squares = 0.0, sumFirst = 0.0, sumSecond = 0.0;
};

void add(Sums& to, const Sums& from) {
  to.both += from.both;
  to.onlyFirst += from.onlyFirst;
  to.onlySecond += from.onlySecond;
  to.largest = std::max(to.largest, from.largest);
  to.squares += from.squares;
  to.sumFirst += from.sumFirst;
  to.sumSecond += from.sumSecond;
}

dvec3 transformed(const glm::dmat4& m, const dvec3& p) { return dvec3(m * dvec4(p, 1.0)); }

/// Stored bricks as coordinates, in index order.
std::vector<ivec3> storedBricks(const BrickVolume& v) {
  std::vector<ivec3> list;
  for (size_t n = 0; n < v.index.size(); ++n)
    if (v.index[n] != 0) {
      const int i = int(n);
      list.push_back(v.brickMin + ivec3(i % v.brickCount.x, i / v.brickCount.x % v.brickCount.y,
                                        i / (v.brickCount.x * v.brickCount.y)));
    }
  return list;
}

bool holdsBrick(const BrickVolume& v, const ivec3& brick) {
  const ivec3 at = brick - v.brickMin;
  for (int axis = 0; axis < 3; ++axis)
    if (at[axis] < 0 || at[axis] >= v.brickCount[axis]) return false;
  return v.index[size_t(at.x) +
                 size_t(v.brickCount.x) * (size_t(at.y) + size_t(v.brickCount.y) * size_t(at.z))] != 0;
}

/// Compares all samples of `first`'s bricks with `second` read at the same places.
Sums overSamples(const BrickVolume& first, const BrickVolume& second, const std::vector<ivec3>& bricks) {
  const glm::dmat4 map = glm::inverse(second.worldFromIndex) * first.worldFromIndex;
  const bool same = first.worldFromIndex == second.worldFromIndex;
  std::vector<Sums> parts(bricks.size());
  tbb::parallel_for(size_t(0), bricks.size(), [&](size_t n) {
    Sums& part = parts[n];
    for (int k = 0; k < kBrickCells; ++k)
      for (int j = 0; j < kBrickCells; ++j)
        for (int i = 0; i < kBrickCells; ++i) {
          const dvec3 at(bricks[n] * kBrickCells + ivec3(i, j, k));
          const double a = densityAt(first, at), b = densityAt(second, same ? at : transformed(map, at));
          if (a <= 0.0 && b <= 0.0) continue;
          part.both += a > 0.0 && b > 0.0;
          part.onlyFirst += b <= 0.0;
          part.onlySecond += a <= 0.0;
          part.largest = std::max(part.largest, std::abs(a - b));
          part.squares += (a - b) * (a - b);
          part.sumFirst += a;
          part.sumSecond += b;
        }
  });
  Sums sums;
  for (const Sums& part : parts) add(sums, part);
  return sums;
}

/// The world box of a grid's support, one voxel beyond its active voxels.
void growBox(const BrickVolume& v, dvec3& low, dvec3& high) {
  if (v.empty()) return;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
    const dvec3 at =
        transformed(v.worldFromIndex, dvec3(glm::mix(v.activeMin - 1, v.activeMax, glm::bvec3(pick))));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
}

}  // namespace

double GridDifference::relativeDensity() const { return relativeTo(maximumA, largest); }
double GridDifference::relativeRmse() const { return relativeTo(meanA, rms); }
double GridDifference::relativeDepth() const { return relativeTo(largestDepthA, largestDepth); }
double GridDifference::relativeVelocity() const { return relativeTo(largestSpeedA, largestVelocity); }

DepthDifference depthDifference(const BrickVolume& a, const BrickVolume& b, uint64_t rays, uint64_t seed) {
  dvec3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
  growBox(a, low, high);
  growBox(b, low, high);
  const Chords chords = randomChords(low, high, rays, seed);
  return differenceOf(depthsAlong(a, chords.lines), depthsAlong(b, chords.lines));
}

GridDifference difference(const BrickVolume& a, const BrickVolume& b, uint64_t rays) {
  GridDifference d;
  d.sameTransform = a.worldFromIndex == b.worldFromIndex;
  d.maximumA = a.maximum;
  Sums samples = overSamples(a, b, storedBricks(a));
  std::vector<ivec3> rest;
  for (const ivec3& brick : storedBricks(b))
    if (!d.sameTransform || !holdsBrick(a, brick)) rest.push_back(brick);
  Sums other = overSamples(b, a, rest);
  std::swap(other.onlyFirst, other.onlySecond);
  std::swap(other.sumFirst, other.sumSecond);
  add(samples, other);
  d.voxelsBoth = samples.both;
  d.voxelsOnlyA = samples.onlyFirst;
  d.voxelsOnlyB = samples.onlySecond;
  d.largest = samples.largest;
  const uint64_t counted = samples.both + samples.onlyFirst + samples.onlySecond;
  d.rms = counted > 0 ? std::sqrt(samples.squares / double(counted)) : 0.0;
  d.meanA = counted > 0 ? samples.sumFirst / double(counted) : 0.0;
  const DepthDifference depths = depthDifference(a, b, rays);
  d.rays = rays;
  d.largestDepthA = depths.largestA;
  d.largestDepth = depths.largest;
  d.rmsDepth = depths.rms;
  return d;
}

GridDifference differenceOfFiles(const std::string& pathA, const std::string& pathB) {
  GridDifference d = difference(loadBricks(pathA), loadBricks(pathB));
  compareVelocities(pathA, pathB, d);
  return d;
}

std::string differenceAsText(const GridDifference& d) {
  char text[512];
  std::snprintf(text, sizeof text,
                "density: largest difference %.6g (%.4g%% of %.6g), RMS %.6g\n"
                "optical depth, %llu rays: largest difference %.6g (%.4g%% of %.6g), RMS %.6g\n"
                "voxels above 0: %llu in both, %llu in the first alone, %llu in the second alone%s\n",
                d.largest, 100.0 * d.relativeDensity(), d.maximumA, d.rms,
                static_cast<unsigned long long>(d.rays), d.largestDepth, 100.0 * d.relativeDepth(),
                d.largestDepthA, d.rmsDepth, static_cast<unsigned long long>(d.voxelsBoth),
                static_cast<unsigned long long>(d.voxelsOnlyA),
                static_cast<unsigned long long>(d.voxelsOnlyB),
                d.sameTransform ? "" : " (transforms differ: each was read between its samples)");
  std::string all = text;
  if (d.velocities) {
    std::snprintf(text, sizeof text, "velocity: largest difference %.6g (%.4g%% of %.6g)\n",
                  d.largestVelocity, 100.0 * d.relativeVelocity(), d.largestSpeedA);
    all += text;
  }
  return all;
}

std::string differenceAsJson(const GridDifference& d, const std::string& pathA, const std::string& pathB) {
  nlohmann::ordered_json json{
      {"a", pathA},
      {"b", pathB},
      {"same_transform", d.sameTransform},
      {"density",
       {{"largest", d.largest},
        {"relative", d.relativeDensity()},
        {"rms", d.rms},
        {"relative_rmse", d.relativeRmse()},
        {"maximum_a", d.maximumA}}},
      {"optical_depth",
       {{"rays", d.rays},
        {"largest", d.largestDepth},
        {"relative", d.relativeDepth()},
        {"rms", d.rmsDepth},
        {"largest_a", d.largestDepthA}}},
      {"voxels", {{"both", d.voxelsBoth}, {"only_a", d.voxelsOnlyA}, {"only_b", d.voxelsOnlyB}}}};
  if (d.velocities)
    json["velocity"] = {{"largest", d.largestVelocity},
                        {"relative", d.relativeVelocity()},
                        {"largest_speed_a", d.largestSpeedA}};
  return json.dump(2) + "\n";
}

}  // namespace nephele
