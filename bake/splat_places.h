// Where particles lie among voxels: frames, reaches, and lists of the particles that each tile of 64³ voxels
// needs. Part of splat; depends on splat.h and splat_kernels.h, no OpenVDB.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "bake/splat.h"
#include "bake/splat_kernels.h"

namespace nephele {

inline constexpr int kTileEdge = 64;
// Index coordinates stay well inside 32 bits, so that no neighbour or box overflows.
inline constexpr double kLargestIndex = 1073741824.0;

/// How a particle becomes voxels, in the order in which a leaf takes them.
enum class SplatWay { round, point, shaped };

/// One particle in index space.
struct SplatFrame {
  SplatWay way = SplatWay::round;
  SplatRecord record;  // its cell in the grid's frame; scale 0
  SplatShape shape;
  glm::ivec3 low{0}, high{0};  // voxels that it can reach, both included
};

/// Turns particles into frames and sorts them by tile. Immutable once built; keeps references to its
/// arguments.
class SplatPlaces {
 public:
  /// Throws SplatError on particles that cannot be splatted.
  SplatPlaces(const SplatParticles& particles, const SplatSettings& settings);

  /// Whether particles may be stretched or eroded; where not, placeOf() says all of them.
  bool anyShaped() const {
    return settings_.shutterSeconds > 0.0 || (settings_.erosion && settings_.erosionAmount > 0.0);
  }
  SplatFrame frameOf(size_t particle) const { return frameOf(particle, settings_.voxelSize); }
  /// Among other voxels.
  SplatFrame frameOf(size_t particle, double voxelSize) const;
  /// A particle that is neither stretched nor eroded, its cell in the grid's frame, scale 0.
  SplatRecord placeOf(size_t particle) const { return placeOf(particle, perVoxel_); }
  /// In voxels.
  float radiusOf(size_t particle) const { return float(double(particles_.radius[particle]) * perVoxel_); }
  /// The largest radius, in voxels.
  float widest() const { return widest_; }
  /// Σ of all masses.
  double mass() const { return mass_; }
  /// Asks the memory for a particle that will be needed soon.
  void prefetch(size_t particle) const;

  /// Tiles that particles reach, in a fixed order.
  size_t tileCount() const { return tiles_.size(); }
  glm::ivec3 tileOrigin(size_t tile) const;
  /// The particles that reach a tile, by growing number.
  std::span<const uint32_t> particlesOf(size_t tile) const;

 private:
  SplatRecord placeOf(size_t particle, double perVoxel) const;
  void refuse(size_t particle, const std::string& what) const;
  void check(size_t particle) const;
  bool looksGood(size_t particle) const;
  double reachOf(size_t particle) const;
  void findBox();
  void sortByTile();
  template <class Body>
  void forEachTileOf(size_t particle, const Body& body) const;

  const SplatParticles& particles_;
  const SplatSettings& settings_;
  const double perVoxel_;  // 1 over a voxel's size
  float widest_ = 0.0f;
  double mass_ = 0.0;
  glm::ivec3 lowTile_{0}, tileBox_{0};  // the box of tiles that holds all particles
  std::vector<uint32_t> tiles_;         // place of each used tile in that box
  std::vector<uint64_t> starts_;        // of each used tile in entries_
  std::vector<uint32_t> entries_;
};

inline SplatRecord SplatPlaces::placeOf(size_t n, double perVoxel) const {
  SplatRecord record;
  const float place[] = {particles_.x[n], particles_.y[n], particles_.z[n]};
  for (int axis = 0; axis < 3; ++axis) {
    const double at = double(place[axis]) * perVoxel;
    const int32_t cell = floorToInt(at);
    const float rest = float(at - double(cell));
    // A rest that rounds up to a voxel is the next voxel's 0.
    record.cell[axis] = rest < 1.0f ? cell : cell + 1;
    record.rest[axis] = rest < 1.0f ? rest : 0.0f;
  }
  record.radius = float(double(particles_.radius[n]) * perVoxel);
  record.scale = 0.0f;
  return record;
}

inline void SplatPlaces::prefetch(size_t n) const {
  for (const auto* values : {&particles_.x, &particles_.y, &particles_.z, &particles_.radius})
    __builtin_prefetch(values->data() + n);
}

}  // namespace nephele
