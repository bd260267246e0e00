// Velocities on the voxels of a density. Depends on voxelize_grid.h, base, OpenVDB, TBB.
#include <openvdb/tools/Prune.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bake/voxelize.h"
#include "bake/voxelize_grid.h"
#include "base/half.h"

namespace nephele {
namespace {

using Leaf = openvdb::Vec3STree::LeafNodeType;

float stored(float value, const openvdb::Coord& leaf, bool half) {
  if (!std::isfinite(value) || (half && std::abs(value) > kLargestHalf))
    throw VoxelizeError("the velocity reaches " + std::to_string(value) + " in the block at voxel (" +
                        std::to_string(leaf.x()) + ", " + std::to_string(leaf.y()) + ", " +
                        std::to_string(leaf.z()) + "), which the file cannot hold");
  return half ? float(openvdb::math::half(value)) : value;
}

/// Fills the active voxels of a leaf; returns the largest speed among them.
template <class Evaluate>
double fillLeaf(Leaf& leaf, const VoxelizeSettings& settings, const Evaluate& evaluate) {
  float v[3][kBlockPoints];
  const openvdb::Coord origin = leaf.origin();
  evaluate(Lattice{glm::dvec3(origin.x(), origin.y(), origin.z()) * settings.voxelSize, settings.voxelSize},
           v[0], v[1], v[2]);
  double largest = 0.0;
  for (auto value = leaf.beginValueOn(); value; ++value) {
    const size_t n = value.pos();
    const openvdb::Vec3s velocity(stored(v[0][n], origin, settings.half),
                                  stored(v[1][n], origin, settings.half),
                                  stored(v[2][n], origin, settings.half));
    leaf.setValueOnly(openvdb::Index(n), velocity);
    largest = std::max(largest, openvdb::Vec3d(velocity).length());
  }
  return largest;
}

/// Blocks of the tree's active tiles, which hold one density and maybe many velocities.
std::vector<openvdb::Coord> blocksOfTiles(const openvdb::FloatTree& density) {
  std::vector<openvdb::Coord> blocks;
  auto tile = density.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    forEachBlock(box.min(), box.dim().x(), [&](const openvdb::Coord& block) { blocks.push_back(block); });
  }
  return blocks;
}

/// Fills the blocks of tiles, some at a time: a block of one velocity stays a tile. Returns the largest
/// speed.
template <class Evaluate>
double fillBlocks(openvdb::Vec3STree& tree, const std::vector<openvdb::Coord>& blocks,
                  const VoxelizeSettings& settings, const Evaluate& evaluate) {
  constexpr size_t kAtATime = 4096;  // 25 MB
  double largest = 0.0;
  for (size_t first = 0; first < blocks.size(); first += kAtATime) {
    const size_t count = std::min(kAtATime, blocks.size() - first);
    std::vector<std::unique_ptr<Leaf>> leaves(count);
    std::vector<double> speeds(count);
    tbb::parallel_for(size_t(0), count, [&](size_t n) {
      leaves[n] = std::make_unique<Leaf>(blocks[first + n], openvdb::Vec3s(0.0f), true);
      speeds[n] = fillLeaf(*leaves[n], settings, evaluate);
    });
    for (size_t n = 0; n < count; ++n) {
      largest = std::max(largest, speeds[n]);
      openvdb::Vec3s value;
      bool active = true;
      if (leaves[n]->isConstant(value, active))
        tree.addTile(1, blocks[first + n], value, true);
      else
        tree.addLeaf(leaves[n].release());
    }
  }
  return largest;
}

}  // namespace

Velocities voxelizeVelocity(const Voxelized& density, const VoxelizeSettings& settings,
                            const std::function<void(const Lattice&, float*, float*, float*)>& evaluate) {
  auto grid = makeVelocityGrid(settings.voxelSize, settings.half);
  const openvdb::FloatTree& densities = density.grid->grid->tree();
  grid->setTree(
      std::make_shared<openvdb::Vec3STree>(densities, openvdb::Vec3s(0.0f), openvdb::TopologyCopy()));
  openvdb::Vec3STree& tree = grid->tree();
  std::vector<Leaf*> leaves;
  tree.getNodes(leaves);
  std::vector<double> largest(leaves.size());
  tbb::parallel_for(size_t(0), leaves.size(),
                    [&](size_t n) { largest[n] = fillLeaf(*leaves[n], settings, evaluate); });
  largest.push_back(fillBlocks(tree, blocksOfTiles(densities), settings, evaluate));
  openvdb::tools::prune(tree);
  keepALeaf(tree);
  Velocities velocities;
  for (const double speed : largest) velocities.largestSpeed = std::max(velocities.largestSpeed, speed);
  velocities.contentHash = contentHash(*grid);
  auto held = std::make_shared<VelocityGrid>();
  held->grid = std::move(grid);
  velocities.grid = std::move(held);
  return velocities;
}

}  // namespace nephele
