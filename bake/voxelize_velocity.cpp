// Velocities on the voxels of a density. Depends on voxelize_grid.h, OpenVDB, TBB.
#include <openvdb/tools/Prune.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/voxelize.h"
#include "bake/voxelize_grid.h"

namespace nephele {
namespace {

using Leaf = openvdb::Vec3STree::LeafNodeType;

constexpr float kHalfLargest = 65504.0f;

float stored(float value, const openvdb::Coord& leaf, bool half) {
  if (!std::isfinite(value) || (half && std::abs(value) > kHalfLargest))
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

}  // namespace

Velocities voxelizeVelocity(const Voxelized& density, const VoxelizeSettings& settings,
                            const std::function<void(const Lattice&, float*, float*, float*)>& evaluate) {
  auto grid = makeVelocityGrid(settings.voxelSize, settings.half);
  grid->setTree(std::make_shared<openvdb::Vec3STree>(density.grid->grid->tree(), openvdb::Vec3s(0.0f),
                                                     openvdb::TopologyCopy()));
  openvdb::Vec3STree& tree = grid->tree();
  tree.voxelizeActiveTiles();
  std::vector<Leaf*> leaves;
  tree.getNodes(leaves);
  std::vector<double> largest(leaves.size());
  tbb::parallel_for(size_t(0), leaves.size(),
                    [&](size_t n) { largest[n] = fillLeaf(*leaves[n], settings, evaluate); });
  openvdb::tools::prune(tree);
  // As with densities: Blender 3.4 wants leaves.
  if (tree.leafCount() == 0) tree.voxelizeActiveTiles();
  Velocities velocities;
  for (const double speed : largest) velocities.largestSpeed = std::max(velocities.largestSpeed, speed);
  velocities.contentHash = contentHash(*grid);
  auto held = std::make_shared<VelocityGrid>();
  held->grid = std::move(grid);
  velocities.grid = std::move(held);
  return velocities;
}

}  // namespace nephele
