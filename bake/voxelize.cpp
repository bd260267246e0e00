// Density fields → sparse grids. Interval bounds cull from the root down, leaves are filled in parallel
// without an accessor, and put into the tree in a fixed order. Depends on fields, volume, OpenVDB, TBB.
#include "bake/voxelize.h"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

#include "bake/voxelize_grid.h"
#include "bake/voxelize_kernels.h"

namespace nephele {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using openvdb::Coord;

// Index coordinates stay well inside 32 bits, so that no neighbour or box overflows.
constexpr double kLargestIndex = 1073741824.0;
// A recipe that asks for a larger box than this is refused: dense it would take 4 TB.
constexpr double kMostVoxels = 1e12;
// Boxes along the way down: first the tree's 128³ nodes, then halves down to leaves.
constexpr int kRootEdge = 128;
constexpr float kHalfLargest = 65504.0f;
constexpr int kWordBits = 64;

/// A cube of 8³, 16³ … 128³ voxels that may hold something.
struct Cube {
  Coord origin;
  int edge;
};

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The index box that the field's support needs, whole cubes of 128; nothing where the support is empty.
openvdb::CoordBBox indexBox(const Box& support, double voxelSize) {
  if (support.empty()) return {};
  double voxels = 1.0;
  openvdb::CoordBBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(support.low[axis] / voxelSize),
                 high = std::ceil(support.high[axis] / voxelSize);
    if (!std::isfinite(low) || !std::isfinite(high))
      throw VoxelizeError(std::string("the density fills all of space along ") + "xyz"[axis] +
                          "; multiply it by a shape that ends, as a sphere");
    if (low < -kLargestIndex || high > kLargestIndex)
      throw VoxelizeError("the density reaches voxel " + shown(std::max(-low, high)) + " along " +
                          "xyz"[axis] + ", beyond 2^30; use larger voxels or stay nearer to the origin");
    voxels *= high - low + 1.0;
    box.min()[axis] = int(low) & ~(kRootEdge - 1);
    box.max()[axis] = int(high) | (kRootEdge - 1);
  }
  if (voxels > kMostVoxels)
    throw VoxelizeError("the density's box holds " + shown(voxels) + " voxels (" + shown(voxels * 4e-9) +
                        " GB if dense), more than " + shown(kMostVoxels) + "; use larger voxels");
  return box;
}

class Voxelizer {
 public:
  Voxelizer(const Field& field, const VoxelizeSettings& settings, const LeafProgress& progress)
      : field_(field),
        settings_(settings),
        rules_{float(settings.cutoff), settings.half ? kHalfLargest : std::numeric_limits<float>::max(),
               settings.half},
        progress_(progress) {}

  Voxelized run() {
    if (settings_.voxelSize < kSmallestVoxel)
      throw VoxelizeError("voxels of " + shown(settings_.voxelSize) + " world units are below " +
                          shown(kSmallestVoxel) + ", the smallest that a .vdb can hold; use larger units");
    findLeaves(indexBox(field_.support(), settings_.voxelSize));
    fillLeaves();
    return gather();
  }

 private:
  Box worldBox(const Cube& cube) const {
    const glm::dvec3 low(cube.origin.x(), cube.origin.y(), cube.origin.z());
    return roundedOutwards({low * settings_.voxelSize, (low + double(cube.edge - 1)) * settings_.voxelSize});
  }

  /// Appends the leaves under `cube` that may hold values above the cutoff, in a fixed order.
  void descend(const Cube& cube, std::vector<Coord>& leaves) const {
    if (field_.bounds(worldBox(cube)).high <= settings_.cutoff) return;
    if (cube.edge == kBlockEdge) {
      leaves.push_back(cube.origin);
      return;
    }
    const int half = cube.edge / 2;
    for (int octant = 0; octant < 8; ++octant)
      descend(
          {cube.origin.offsetBy(octant & 4 ? half : 0, octant & 2 ? half : 0, octant & 1 ? half : 0), half},
          leaves);
  }

  void findLeaves(const openvdb::CoordBBox& box) {
    if (box.empty()) return;
    std::vector<Coord> roots;
    for (int x = box.min().x(); x <= box.max().x(); x += kRootEdge)
      for (int y = box.min().y(); y <= box.max().y(); y += kRootEdge)
        for (int z = box.min().z(); z <= box.max().z(); z += kRootEdge) roots.emplace_back(x, y, z);
    std::vector<std::vector<Coord>> found(roots.size());
    tbb::parallel_for(size_t(0), roots.size(), [&](size_t n) { descend({roots[n], kRootEdge}, found[n]); });
    for (const auto& leaves : found) origins_.insert(origins_.end(), leaves.begin(), leaves.end());
  }

  /// What one leaf adds to the sums; summed in leaf order, so that the result does not depend on threads.
  struct LeafSums {
    double mass = 0.0;
    float maximum = 0.0f;
  };

  void fillLeaves() {
    leaves_.resize(origins_.size());
    sums_.resize(origins_.size());
    std::atomic<uint64_t> done{0};
    // 16 leaves make a task long enough to pay for its scheduling.
    tbb::parallel_for(tbb::blocked_range<size_t>(0, origins_.size(), 16),
                      [&](const tbb::blocked_range<size_t>& range) {
                        for (size_t n = range.begin(); n < range.end(); ++n)
                          leaves_[n] = fillLeaf(origins_[n], sums_[n]);
                        const uint64_t now = done += range.size();
                        if (progress_) progress_(now, origins_.size());
                      });
  }

  /// The leaf at `origin`, or null where nothing in it exceeds the cutoff.
  std::unique_ptr<Leaf> fillLeaf(const Coord& origin, LeafSums& sums) const {
    alignas(kBlockAlignment) float values[kBlockPoints];
    const Lattice lattice{glm::dvec3(origin.x(), origin.y(), origin.z()) * settings_.voxelSize,
                          settings_.voxelSize};
    field_.evaluate(lattice, values);
    const LeafScan scan = scanLeaf(rules_, values);
    if (!scan.storable) {
      field_.evaluate(lattice, values);
      refuseUnstorable(origin, values);
    }
    if (!scan.active) return nullptr;
    sums = {scan.mass, scan.maximum};
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), origin, 0.0f);
    leaf->allocate();
    std::copy_n(values, kBlockPoints, leaf->buffer().data());
    Leaf::NodeMaskType mask;
    for (int word = 0; word < kBlockPoints / kWordBits; ++word)
      mask.getWord<uint64_t>(openvdb::Index(word)) = scan.mask[word];
    leaf->setValueMask(mask);
    return leaf;
  }

  /// Throws where a value is not finite, or is more than the file's precision holds.
  void refuseUnstorable(const Coord& origin, const float* values) const {
    for (int n = 0; n < kBlockPoints; ++n) {
      if (!std::isfinite(values[n])) throw VoxelizeError("the density is not finite" + placeOf(origin, n));
      if (values[n] > rules_.limit)
        throw VoxelizeError("the density reaches " + shown(double(values[n])) + placeOf(origin, n) +
                            ", more than half precision holds (65504); ask for 'precision: float'");
    }
  }

  std::string placeOf(const Coord& origin, int n) const {
    const Coord at = origin + Leaf::offsetToLocalCoord(openvdb::Index(n));
    return " at (" + shown(at.x() * settings_.voxelSize) + ", " + shown(at.y() * settings_.voxelSize) + ", " +
           shown(at.z() * settings_.voxelSize) + ")";
  }

  Voxelized gather() {
    Voxelized result;
    result.voxelsEvaluated = origins_.size() * uint64_t(kBlockPoints);
    auto voxels = std::make_shared<VoxelGrid>();
    voxels->grid = makeFogGrid("density", settings_.voxelSize, settings_.half);
    openvdb::FloatTree& tree = voxels->grid->tree();
    const double volume = settings_.voxelSize * settings_.voxelSize * settings_.voxelSize;
    openvdb::tree::ValueAccessor<openvdb::FloatTree> accessor(tree);
    for (size_t n = 0; n < leaves_.size(); ++n) {
      result.mass += sums_[n].mass * volume;
      result.maximum = std::max(result.maximum, double(sums_[n].maximum));
      if (leaves_[n]) accessor.addLeaf(leaves_[n].release());
    }
    openvdb::tools::prune(tree);
    // Blender 3.4 draws nothing for a grid that holds active tiles alone.
    if (tree.leafCount() == 0) tree.voxelizeActiveTiles();
    result.voxelsActive = tree.activeVoxelCount();
    result.gridBytes = tree.memUsage();
    if (result.voxelsActive > 0) {
      const Coord size = voxels->grid->evalActiveVoxelDim();
      result.longestAxis = std::max({size.x(), size.y(), size.z()});
    }
    result.grid = std::move(voxels);
    return result;
  }

  const Field& field_;
  const VoxelizeSettings settings_;
  const LeafRules rules_;
  const LeafProgress& progress_;
  std::vector<Coord> origins_;
  std::vector<std::unique_ptr<Leaf>> leaves_;
  std::vector<LeafSums> sums_;
};

}  // namespace

Voxelized voxelize(const Field& field, const VoxelizeSettings& settings, const LeafProgress& progress) {
  return Voxelizer(field, settings, progress).run();
}

std::string contentHashOf(const Voxelized& voxelized) { return contentHash(*voxelized.grid->grid); }

BrickVolume bricksOf(const Voxelized& voxelized) { return bricksFromGrid(*voxelized.grid->grid); }

uint64_t writeDensity(const std::string& path, const Voxelized& voxelized, const Provenance& provenance,
                      const Velocities* velocities) {
  Provenance complete = provenance;
  complete.mass = voxelized.mass;
  openvdb::GridCPtrVec grids{voxelized.grid->grid};
  if (velocities) grids.push_back(velocities->grid->grid);
  return writeVdb(path, grids, complete);
}

}  // namespace nephele
