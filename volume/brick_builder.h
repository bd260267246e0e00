// From a source of samples to a BrickVolume: which bricks hold anything, which share a slot. No OpenVDB.
#pragma once

#include <glm/vec3.hpp>

#include "volume/bricks.h"

namespace nephele {

/// What a grid says of its bricks. Called from many threads at once.
class BrickSource {
 public:
  virtual ~BrickSource() = default;
  /// True where all samples of the brick are one value that is known without reading them.
  virtual bool isConstant(const glm::ivec3& brick, float& value) const = 0;
  /// The brick's 729 samples, each finite and at least 0, x fastest, then y, then z.
  virtual void read(const glm::ivec3& brick, float* samples) const = 0;
};

/// Fills slots, index and maxima. On entry brickMin and brickCount are set, and `index` (x fastest) holds 1
/// for each brick to look at and 0 for the rest. The result is the same on any number of threads: slots in
/// order of the index, a constant's slot where it comes first. Where no sample is above 0 the index becomes
/// empty.
void buildBricks(BrickVolume& volume, const BrickSource& source);

/// Index of a brick in BrickVolume::index, or -1 outside.
int64_t indexOf(const BrickVolume& volume, const glm::ivec3& brick);

}  // namespace nephele
