// The voxels that rays read of a grid, so that no others need be evaluated. Depends on chords.h; OpenVDB
// stays behind this header.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>

#include "volume/chords.h"

namespace nephele {

/// A bit for each of 8³ voxels, z fastest.
using LeafMask = std::array<uint64_t, 8>;

/// Immutable, safe to share between threads.
class ChordVoxels {
 public:
  /// Those that depthsAlong() reads of voxels of this size, sample (0, 0, 0) at the world's origin, and that
  /// lie in the box [low, high], world units.
  ChordVoxels(std::span<const Chord> chords, double voxelSize, const glm::dvec3& low, const glm::dvec3& high);
  ~ChordVoxels();

  /// Those of the 8³ voxels from `origin` (a multiple of 8); none where no ray comes near.
  std::optional<LeafMask> ofLeaf(const glm::ivec3& origin) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace nephele
