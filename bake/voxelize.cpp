// Density fields → sparse grids: leaves are filled in parallel without an accessor, and put into the tree in
// a fixed order; constant space becomes tiles. Depends on voxelize_fill.h, volume, OpenVDB, TBB.
#include "bake/voxelize.h"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <memory>
#include <vector>

#include "bake/voxelize_fill.h"
#include "bake/voxelize_grid.h"

namespace nephele {

namespace {

class Voxelizer {
 public:
  Voxelizer(const Field& field, const VoxelizeSettings& settings, const LeafProgress& progress)
      : filler_(field, settings), settings_(settings), progress_(progress) {}

  Voxelized run() {
    found_ = filler_.find();
    fillLeaves();
    return gather();
  }

 private:
  void fillLeaves() {
    const size_t count = found_.origins.size();
    leaves_.resize(count);
    sums_.resize(count);
    std::atomic<uint64_t> done{0}, held{0};
    // 16 leaves make a task long enough to pay for its scheduling.
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 16), [&](const tbb::blocked_range<size_t>& range) {
      for (size_t n = range.begin(); n < range.end(); ++n) {
        leaves_[n] = filler_.fill(found_.origins[n], sums_[n]);
        if (leaves_[n] && double(++held) * bytesOfLeaf(settings_) > double(settings_.memoryBytes))
          throw tooMuchMemory(double(held) / double(done + 1) * double(count), settings_);
      }
      const uint64_t now = done += range.size();
      if (progress_) progress_(now, count);
    });
  }

  Voxelized gather() {
    Voxelized result;
    result.voxelsEvaluated = found_.origins.size() * uint64_t(kBlockPoints);
    auto voxels = std::make_shared<VoxelGrid>();
    voxels->grid = makeFogGrid("density", settings_.voxelSize, settings_.half);
    openvdb::FloatTree& tree = voxels->grid->tree();
    // In the order found, so that sums do not depend on threads.
    addTiles(tree, result);
    addLeaves(tree, result);
    result.mass *= settings_.voxelSize * settings_.voxelSize * settings_.voxelSize;
    openvdb::tools::prune(tree);
    keepALeaf(tree);
    result.voxelsActive = tree.activeVoxelCount();
    result.gridBytes = tree.memUsage();
    if (result.voxelsActive > 0) {
      const openvdb::Coord size = voxels->grid->evalActiveVoxelDim();
      result.longestAxis = std::max({size.x(), size.y(), size.z()});
    }
    result.grid = std::move(voxels);
    return result;
  }

  void addTiles(openvdb::FloatTree& tree, Voxelized& result) const {
    for (const ConstantCube& cube : found_.constant) {
      tree.fill(openvdb::CoordBBox::createCube(cube.origin, cube.edge), cube.value, true);
      const double edge(cube.edge);
      result.mass += double(cube.value) * edge * edge * edge;
      result.maximum = std::max(result.maximum, double(cube.value));
    }
  }

  void addLeaves(openvdb::FloatTree& tree, Voxelized& result) {
    openvdb::tree::ValueAccessor<openvdb::FloatTree> accessor(tree);
    for (size_t n = 0; n < leaves_.size(); ++n) {
      result.mass += sums_[n].mass;
      result.maximum = std::max(result.maximum, double(sums_[n].maximum));
      if (leaves_[n]) accessor.addLeaf(leaves_[n].release());
    }
  }

  const LeafFiller filler_;
  const VoxelizeSettings settings_;
  const LeafProgress& progress_;
  Occupied found_;
  std::vector<std::unique_ptr<DensityLeaf>> leaves_;
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
