// How far a field is from a grid that was baked: the seam of a loop. Depends on voxelize_fill.h, volume,
// OpenVDB, TBB.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "bake/voxelize_fill.h"
#include "bake/voxelize_grid.h"
#include "volume/content_hasher.h"

namespace nephele {
namespace {

using openvdb::Coord;

// Leaves that are held at a time: 9 MB.
constexpr size_t kLeavesAtATime = 4096;

/// The largest difference of two blocks; either may be a leaf, or one value.
double apart(const DensityLeaf* a, float aValue, const DensityLeaf* b, float bValue) {
  double largest = 0.0;
  for (openvdb::Index n = 0; n < openvdb::Index(kBlockPoints); ++n)
    largest = std::max(largest,
                       std::abs(double(a ? a->getValue(n) : aValue) - double(b ? b->getValue(n) : bValue)));
  return largest;
}

class Comparison {
 public:
  Comparison(const openvdb::FloatGrid& grid, const Field& field, const VoxelizeSettings& settings,
             const LeafProgress& progress)
      : grid_(grid), filler_(field, settings), progress_(progress), hasher_(grid) {}

  DensityChange run() {
    Occupied found = filler_.find();
    std::sort(found.origins.begin(), found.origins.end());
    for (const ConstantCube& cube : found.constant) takeConstant(cube);
    for (size_t first = 0; first < found.origins.size(); first += kLeavesAtATime) {
      takeLeaves(found.origins.data() + first, std::min(kLeavesAtATime, found.origins.size() - first));
      if (progress_) progress_(std::min(first + kLeavesAtATime, found.origins.size()), found.origins.size());
    }
    takeRest();
    return {largest_, hasher_.finish()};
  }

 private:
  void takeConstant(const ConstantCube& cube) {
    seen_.fill(openvdb::CoordBBox::createCube(cube.origin, cube.edge), true, true);
    // Tiles as the tree has them.
    const int edge = cube.edge >= kRootEdge ? kRootEdge : cube.edge >= kCoarseEdge ? kCoarseEdge : kBlockEdge;
    for (int x = 0; x < cube.edge; x += edge)
      for (int y = 0; y < cube.edge; y += edge)
        for (int z = 0; z < cube.edge; z += edge)
          hasher_.tile(cube.origin.offsetBy(x, y, z), edge, cube.value);
    const auto accessor = grid_.getConstAccessor();
    forEachBlock(cube.origin, cube.edge, [&](const Coord& block) {
      if (const DensityLeaf* const before = accessor.probeConstLeaf(block))
        largest_ = std::max(largest_, apart(before, 0.0f, nullptr, cube.value));
      else
        largest_ = std::max(largest_, std::abs(double(accessor.getValue(block)) - double(cube.value)));
    });
  }

  void takeLeaves(const Coord* origins, size_t count) {
    std::vector<std::unique_ptr<DensityLeaf>> leaves(count);
    std::vector<double> differences(count);
    tbb::parallel_for(size_t(0), count, [&](size_t n) {
      LeafSums sums;
      leaves[n] = filler_.fill(origins[n], sums);
      const DensityLeaf* const before = grid_.tree().probeConstLeaf(origins[n]);
      differences[n] =
          apart(before, before ? 0.0f : grid_.tree().getValue(origins[n]), leaves[n].get(), 0.0f);
    });
    std::vector<const DensityLeaf*> held;
    for (size_t n = 0; n < count; ++n) {
      seen_.addTile(1, origins[n], true, true);
      largest_ = std::max(largest_, differences[n]);
      if (leaves[n]) held.push_back(leaves[n].get());
    }
    hasher_.leaves(held);
  }

  /// What the grid holds where the field holds nothing.
  void takeRest() {
    for (auto leaf = grid_.tree().cbeginLeaf(); leaf; ++leaf)
      if (!seen_.isValueOn(leaf->origin()))
        largest_ = std::max(largest_, apart(leaf.getLeaf(), 0.0f, nullptr, 0.0f));
    auto tile = grid_.tree().cbeginValueOn();
    tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      const openvdb::CoordBBox box = tile.getBoundingBox();
      forEachBlock(box.min(), box.dim().x(), [&](const Coord& block) {
        if (!seen_.isValueOn(block)) largest_ = std::max(largest_, std::abs(double(*tile)));
      });
    }
  }

  const openvdb::FloatGrid& grid_;
  const LeafFiller filler_;
  const LeafProgress& progress_;
  ContentHasher<openvdb::FloatTree> hasher_;
  openvdb::BoolTree seen_{false};  // blocks that were compared
  double largest_ = 0.0;
};

}  // namespace

DensityChange changeFrom(const Voxelized& grid, const Field& field, const VoxelizeSettings& settings,
                         const LeafProgress& progress) {
  return Comparison(*grid.grid->grid, field, settings, progress).run();
}

}  // namespace nephele
