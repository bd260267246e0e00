// Density fields → sparse grids: which leaves can hold anything, parallel fill, prune. Depends on fields,
// volume, TBB; OpenVDB stays behind this header.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "bake/fields/field.h"
#include "volume/bricks.h"
#include "volume/provenance.h"

namespace nephele {

struct VoxelizeSettings {
  double voxelSize = 1.0;  // world units, > 0; sample (0, 0, 0) lies at the world's origin
  double cutoff = 0.001;   // values at or below become inactive and 0
  bool half = true;        // round values to half precision, as the file will store them
};

/// OpenVDB's grid "density", pruned at tolerance 0.
struct VoxelGrid;

struct Voxelized {
  std::shared_ptr<const VoxelGrid> grid;
  uint64_t voxelsActive = 0;
  uint64_t gridBytes = 0;  // in memory
  int longestAxis = 0;     // voxels along the longest side of the active box
  uint64_t voxelsEvaluated = 0;
  double mass = 0.0;  // Σ of stored values · voxel volume
  double maximum = 0.0;
};

/// A density that cannot be baked: it fills all of space, is not finite, exceeds what half can hold, or needs
/// too many voxels. The sentence says which, with the numbers.
class VoxelizeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Called from worker threads with the number of leaves done and the number known; may be empty.
using LeafProgress = std::function<void(uint64_t leaves, uint64_t total)>;

/// Samples the field at the lattice of voxelSize wherever its bounds allow a value above the cutoff. The grid
/// is the same on any number of threads. A density that is nowhere above the cutoff gives an empty grid.
/// Throws VoxelizeError.
Voxelized voxelize(const Field& field, const VoxelizeSettings& settings, const LeafProgress& progress = {});

/// The grid's content hash (volume/vdb_file.h), 32 hex digits.
std::string contentHashOf(const Voxelized& voxelized);

/// The grid as plain bricks.
BrickVolume bricksOf(const Voxelized& voxelized);

/// The largest |density difference| over all voxels. 0 where the grids' voxels and values are the same.
double largestDifference(const Voxelized& a, const Voxelized& b);

/// OpenVDB's grid "vel", pruned at tolerance 0.
struct VelocityGrid;

struct Velocities {
  std::shared_ptr<const VelocityGrid> grid;
  double largestSpeed = 0.0;  // world units per second, as stored
  std::string contentHash;
};

/// Velocities at the density's active voxels, in its precision, by leaves in parallel. `evaluate` fills 512
/// floats a component for a block, world units per second. The same on any number of threads. Throws
/// VoxelizeError where one is not finite or more than the precision holds.
Velocities voxelizeVelocity(
    const Voxelized& density, const VoxelizeSettings& settings,
    const std::function<void(const Lattice& lattice, float* x, float* y, float* z)>& evaluate);

/// Writes the grid, and the velocities where there are any, to `path`, whole or not at all; returns the
/// file's size in bytes. Throws WorldError.
uint64_t writeDensity(const std::string& path, const Voxelized& voxelized, const Provenance& provenance,
                      const Velocities* velocities = nullptr);

}  // namespace nephele
