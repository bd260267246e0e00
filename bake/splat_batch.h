// Particles of one tile, taken in by batches and sorted by what they touch. Part of splat; depends on
// splat_places.h, splat_kernels.h, no OpenVDB.
#pragma once

#include <vector>

#include "bake/splat_places.h"

namespace nephele {

inline constexpr int kTileLeaves = kTileEdge / kLeafEdge;
inline constexpr int kLeavesOfTile = kTileLeaves * kTileLeaves * kTileLeaves;
inline constexpr int kSplatWays = 3;

/// Particles of one batch of a tile, and for each leaf and way those that reach it.
struct SplatBatch {
  std::span<const uint32_t> particles;
  std::vector<SplatRecord> records;  // those that leaves take, cells in the tile's frame
  std::vector<uint32_t> owners;      // the particle of each record
  std::vector<SplatRecord> small;    // those that the tile takes whole
  std::vector<uint32_t> smallOrder;  // the same, neighbours after each other
  std::vector<SplatExtras> extras;
  std::vector<uint32_t> starts, list;  // of each leaf and way

  std::span<const uint32_t> listOf(int leaf, SplatWay way) const {
    const size_t at = size_t(leaf * kSplatWays + int(way));
    return std::span(list).subspan(starts[at], starts[at + 1] - starts[at]);
  }
};

/// Sorts particles of a tile. Immutable, safe to share between threads; keeps references to its arguments.
class SplatSorter {
 public:
  /// `scales` holds what each particle's kernel is multiplied by; below 0: a point. Empty where tiles take
  /// all particles whole or as points.
  SplatSorter(const SplatParticles& particles, const SplatSettings& settings, const SplatPlaces& places,
              const std::vector<float>& scales);

  /// Whether a tile takes the particle whole, and scales its kernel itself.
  bool isSmall(float radiusVoxels) const {
    return takesSmall() && radiusVoxels > 1.0f && radiusVoxels <= SplatTile::kWidest;
  }
  /// Whether no particle needs a scale of its own: each is small, or a point.
  bool allSmall() const { return takesSmall() && places_.widest() <= SplatTile::kWidest; }
  /// Fills the rest of the batch from its `particles`; the tile begins at voxel `tile`.
  void sort(const glm::ivec3& tile, SplatBatch& batch) const;

 private:
  bool takesSmall() const { return !extras_ && !shaped_; }
  struct Reach;
  float scaleOf(size_t particle) const {
    return scales_.empty() ? float(double(particles_.mass[particle]) * perVolume_) : scales_[particle];
  }
  SplatRecord recordOf(size_t particle, const glm::ivec3& tile, Reach& reach) const;
  SplatExtras extrasOf(size_t particle) const;

  const SplatParticles& particles_;
  const SplatSettings& settings_;
  const SplatPlaces& places_;
  const std::vector<float>& scales_;
  const double perVolume_;  // 1 over a voxel's volume
  const bool extras_, shaped_;
};

}  // namespace nephele
