// Random rays through a box, and optical depths along them. Depends on bricks.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "volume/bricks.h"

namespace nephele {

struct Chord {
  glm::dvec3 from{0.0}, to{0.0};  // world
};

/// Ends uniform on the bounding sphere of a box: lines that come from everywhere, evenly.
struct Chords {
  double radius = 0.0;  // of the sphere
  std::vector<Chord> lines;

  /// A region's volume, from the sum of the lengths that all lines have in it: unbiased.
  double volumeOf(double lengthInside) const;
};

/// Depths are sums at midpoints that lie this many voxels apart.
inline constexpr double kDepthStepVoxels = 0.25;

/// `count` chords of the box's bounding sphere; each seed has its own, the same on every machine. None where
/// the box is empty.
Chords randomChords(const glm::dvec3& low, const glm::dvec3& high, uint64_t count, uint64_t seed);

/// A line in index space: midpoints at(n) of equal steps, of which those in some box are [begin, end), and
/// perhaps one beside it at either end.
struct ChordWalk {
  glm::dvec3 start{0.0}, along{0.0};
  int steps = 1, begin = 0, end = 0;

  glm::dvec3 at(int n) const { return start + (n + 0.5) / steps * along; }
};
/// Between two places, by steps of kDepthStepVoxels at most, those in the box [low, high].
ChordWalk walkBetween(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& low,
                      const glm::dvec3& high);

/// ∫ ρ ds along each chord, world units for a medium of unit extinction. Same result on any number of
/// threads. `lengthInside` becomes the sum of the chords' lengths where there is density.
std::vector<double> depthsAlong(const BrickVolume& bricks, std::span<const Chord> chords,
                                double* lengthInside = nullptr);

/// A difference over what it is judged by: 0 where there is none, infinite where the reference alone is 0.
double relativeTo(double reference, double difference);

/// Of depths B against depths A along the same rays.
struct DepthDifference {
  uint64_t rays = 0;
  double largestA = 0.0;  // of all rays
  double largest = 0.0;   // largest |difference|
  double rms = 0.0;

  /// The largest difference over A's largest depth: 0 where both are 0, infinite where only A's is.
  double relative() const;
};

DepthDifference differenceOf(std::span<const double> a, std::span<const double> b);

}  // namespace nephele
