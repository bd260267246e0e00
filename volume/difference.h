// How far one density is from another, for `diff`: voxel by voxel and along random rays. Depends on bricks.h
// and base.
#pragma once

#include <cstdint>
#include <string>

#include "volume/bricks.h"
#include "volume/chords.h"

namespace nephele {

/// B against A. Depths are ∫ ρ ds in world units, for a medium of unit extinction.
struct GridDifference {
  bool sameTransform = false;  // else B is read between its samples at A's, and A at B's
  uint64_t voxelsBoth = 0;   // samples above 0 in both, in A alone, in B alone (each grid's own samples where
  uint64_t voxelsOnlyA = 0;  // transforms differ)
  uint64_t voxelsOnlyB = 0;
  double maximumA = 0.0;  // largest density
  double largest = 0.0;   // largest |density difference|
  double rms = 0.0;       // over samples above 0 in either
  double meanA = 0.0;     // A's mean over the same samples
  uint64_t rays = 0;
  double largestDepthA = 0.0;  // of all rays
  double largestDepth = 0.0;   // largest |depth difference|
  double rmsDepth = 0.0;

  // Grids `vel`: 0 where neither file has one; where one has none, its velocities are 0.
  bool velocities = false;
  double largestSpeedA = 0.0;
  double largestVelocity = 0.0;  // largest |vector difference| at the voxels of either

  /// The figures that --tolerance judges: over A's maximum, A's largest depth, A's largest speed. 0 where
  /// both are 0, infinite where A is empty and B is not.
  double relativeDensity() const;
  double relativeDepth() const;
  double relativeVelocity() const;
  /// Told, not judged: rms over meanA, 0 or infinite as those are.
  double relativeRmse() const;
};

/// Along `rays` random chords of the common box (uniform ends on its bounding sphere); each seed has its own.
/// Same result on any number of threads.
DepthDifference depthDifference(const BrickVolume& a, const BrickVolume& b, uint64_t rays, uint64_t seed = 0);

/// Compares over all samples of both grids and along `rays` random chords of their common box (uniform ends
/// on its bounding sphere, fixed seed). Same result on any number of threads.
GridDifference difference(const BrickVolume& a, const BrickVolume& b, uint64_t rays = 10000);

/// The same for the density grids of two files, and their grids `vel`. Throws as loadBricks does.
GridDifference differenceOfFiles(const std::string& pathA, const std::string& pathB);

/// Fills the figures of velocities from two files. Velocities lie in index space: where voxels differ in
/// size, those of B are read at the voxel nearest to A's. Throws as readVdb does.
void compareVelocities(const std::string& pathA, const std::string& pathB, GridDifference& d);

std::string differenceAsText(const GridDifference& d);
std::string differenceAsJson(const GridDifference& d, const std::string& pathA, const std::string& pathB);

}  // namespace nephele
