// Density fields → sparse grids: which leaves can hold anything, parallel fill, prune. Depends on fields,
// volume, TBB; OpenVDB stays behind this header.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
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
  uint64_t memoryBytes = std::numeric_limits<uint64_t>::max();  // what the grid may take
  uint64_t bytesBeside = 0;  // of that, what other grids take for each leaf of it (kVelocityLeafBytes)
  double densityStep = 0.0;  // values are rounded to multiples of this power of two first; 0: they are not
};

/// What a leaf of 8³ velocities takes in memory, node and allocator included.
inline constexpr uint64_t kVelocityLeafBytes = 6350;

/// OpenVDB's grid "density", pruned at tolerance 0; where that leaves tiles alone, one leaf of them.
struct VoxelGrid;

struct Voxelized {
  std::shared_ptr<const VoxelGrid> grid;
  uint64_t voxelsActive = 0;
  uint64_t gridBytes = 0;        // in memory
  int longestAxis = 0;           // voxels along the longest side of the active box
  uint64_t voxelsEvaluated = 0;  // constant space is not
  double mass = 0.0;             // Σ of stored values · voxel volume
  double maximum = 0.0;
};

/// A density that cannot be baked: it fills all of space, is not finite, exceeds what half can hold, or needs
/// too many voxels or too much memory. The sentence says which, with the numbers.
class VoxelizeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Called from worker threads with the number of leaves done and the number known; may be empty.
using LeafProgress = std::function<void(uint64_t leaves, uint64_t total)>;

/// Throws VoxelizeError where the density fills all of space along an axis, whatever the voxels.
void checkEnds(const Field& field);

/// Throws VoxelizeError where no grid can hold the density: endless or more than 10^12 voxels of box, or
/// surely more than memoryBytes. That is found from bounds of cubes of 128 voxels, and where these do not
/// rule it out from 4000 places among them, at most a second or so. What passes may still be refused by
/// voxelize().
void checkDomain(const Field& field, const VoxelizeSettings& settings);

/// Samples the field at the lattice of voxelSize wherever its bounds allow a value above the cutoff; where
/// they leave one value it becomes a tile. The grid is the same on any number of threads. A density that is
/// nowhere above the cutoff gives an empty grid. Throws VoxelizeError, also as soon as the leaves come to
/// more than memoryBytes.
Voxelized voxelize(const Field& field, const VoxelizeSettings& settings, const LeafProgress& progress = {});

/// The grid's content hash (volume/vdb_file.h), 32 hex digits.
std::string contentHashOf(const Voxelized& voxelized);

/// The grid as plain bricks.
BrickVolume bricksOf(const Voxelized& voxelized);

/// How a density differs from one that was voxelized.
struct DensityChange {
  double largestDifference = 0.0;  // over all voxels, as stored
  std::string contentHash;         // of the field's own grid
};

/// Holds `field`, voxelized with the settings, against `grid`, without a second grid: leaves are filled,
/// compared, hashed and dropped. Throws VoxelizeError.
DensityChange changeFrom(const Voxelized& grid, const Field& field, const VoxelizeSettings& settings,
                         const LeafProgress& progress = {});

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
