// A field on the voxel lattice, before there is a grid: which leaves can hold anything, where space is
// constant, one leaf's voxels. Includes OpenVDB: only bake/voxelize* may include this.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bake/voxelize.h"
#include "bake/voxelize_grid.h"
#include "bake/voxelize_kernels.h"

namespace nephele {

using DensityLeaf = openvdb::FloatTree::LeafNodeType;

/// A cube of 8·2^n voxels that all hold one value.
struct ConstantCube {
  openvdb::Coord origin;
  int edge;
  float value;  // as stored, above 0
};

/// Where a density may exceed the cutoff, in a fixed order.
struct Occupied {
  std::vector<openvdb::Coord> origins;  // of cubes that have to be looked into
  std::vector<ConstantCube> constant;
};

/// What one leaf holds.
struct LeafSums {
  double mass = 0.0;  // Σ of stored values
  float maximum = 0.0f;
};

/// What a grid's leaf of 8³ voxels takes in memory: values, mask, node, and what the allocator and the nodes
/// above add.
inline constexpr uint64_t kLeafBytes = 2250;

/// The edge of the cubes below the tree's top: its nodes', 128 voxels.
inline constexpr int kCoarseEdge = 128;
/// The edge of the tree's largest tiles, with which the way down begins.
inline constexpr int kRootEdge = 4096;

/// What a leaf takes with those of the grids beside it.
inline double bytesOfLeaf(const VoxelizeSettings& settings) {
  return double(kLeafBytes) + double(settings.bytesBeside);
}

/// "the density fills about N voxels, which take N GB of memory, ...".
VoxelizeError tooMuchMemory(double leaves, const VoxelizeSettings& settings);

/// Every method is const and may be called from any number of threads; all throw VoxelizeError.
class LeafFiller {
 public:
  LeafFiller(const Field& field, const VoxelizeSettings& settings);

  /// The index box that the field's support needs, whole cubes of 128; empty where the support is.
  openvdb::CoordBBox box() const;
  /// Cubes of kCoarseEdge, and constant space.
  Occupied findCoarse() const;
  /// The same down to leaves.
  Occupied find() const;
  /// The leaf at `origin`, or null where nothing in it exceeds the cutoff.
  std::unique_ptr<DensityLeaf> fill(const openvdb::Coord& origin, LeafSums& sums) const;

  /// Whether bounds alone say what the leaf at `origin` holds: nothing, or one value.
  bool isSettled(const openvdb::Coord& origin) const;

  /// What bounds say of a cube of `edge` voxels: all its values as stored where they are one, 0 among them.
  std::optional<float> settledValue(const openvdb::Coord& origin, int edge) const;
  /// The 512 voxels from `origin` on, which need not be a leaf's, as stored.
  LeafScan scan(const openvdb::Coord& origin, float* values) const;
  /// The same of the `count` voxels named by their places among the 512; the others are 0.
  LeafScan scan(const openvdb::Coord& origin, const uint16_t* places, size_t count, float* values) const;

 private:
  struct Cube {
    openvdb::Coord origin;
    int edge;
  };

  Box worldBox(const Cube& cube) const;
  void descend(const Cube& cube, int leastEdge, const openvdb::CoordBBox& within, Occupied& found) const;
  float asStored(const openvdb::Coord& origin, float value) const;
  LeafScan kept(const openvdb::Coord& origin, float* values) const;
  [[noreturn]] void refuseUnstorable(const openvdb::Coord& origin, const float* values) const;
  std::string placeOf(const openvdb::Coord& origin, int n) const;

  const Field& field_;
  const VoxelizeSettings settings_;
  const LeafRules rules_;
};

}  // namespace nephele
