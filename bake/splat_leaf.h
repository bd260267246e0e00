// One leaf of the splat's grids while it fills, and what it becomes. Part of splat; depends on splat.h,
// splat_kernels.h, OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include <memory>

#include "bake/splat.h"
#include "bake/splat_kernels.h"

namespace nephele {

inline constexpr int kExtraCount = 5;  // vx, vy, vz, temperature, age

/// Sums of the grids beside density.
struct ExtraSums {
  float values[kExtraCount][kLeafVoxels];
};

/// One leaf while it fills, then what it becomes.
struct OpenLeaf {
  std::unique_ptr<openvdb::FloatTree::LeafNodeType> density, temperature, age;
  std::unique_ptr<openvdb::Vec3STree::LeafNodeType> velocity;
  std::unique_ptr<ExtraSums> extras;
};

/// Opens and closes leaves. Immutable, safe to share between threads; keeps a reference to the settings.
class SplatLeaves {
 public:
  explicit SplatLeaves(const SplatSettings& settings);

  /// Whether there are grids beside density.
  bool extras() const { return settings_.vel || settings_.temperature || settings_.age; }
  /// The voxels of the settings' box; empty where there is none.
  const openvdb::CoordBBox& box() const { return box_; }

  /// Its values are undefined; there must be no grids beside density.
  void allocate(const openvdb::Coord& origin, OpenLeaf& leaf) const;
  /// All sums 0.
  void open(const openvdb::Coord& origin, OpenLeaf& leaf) const;
  /// Turns sums into what the file stores, and adds up the masses, in units of a voxel's volume. The density
  /// is null where no voxel exceeds the cutoff. Throws SplatError on what half precision cannot hold.
  void close(const openvdb::Coord& origin, OpenLeaf& leaf, SplatLedger& ledger, float& maximum) const;

 private:
  void closeExtras(const openvdb::Coord& origin, const float* density, OpenLeaf& leaf) const;
  [[noreturn]] void refuseUnstorable(const openvdb::Coord& origin, const float* values, float limit) const;
  void cutToBox(const openvdb::Coord& origin, float* values) const;

  const SplatSettings& settings_;
  openvdb::CoordBBox box_;
};

}  // namespace nephele
