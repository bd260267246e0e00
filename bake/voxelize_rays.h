// What the voxels of a density would give along rays, without a grid: only voxels that rays come near are
// evaluated. Depends on fields, volume; OpenVDB stays behind this header.
#pragma once

#include <span>
#include <vector>

#include "bake/voxelize.h"
#include "volume/chords.h"

namespace nephele {

struct RayDepths {
  std::vector<double> depths;  // one a chord
  double lengthVaried = 0.0;  // Σ of the chords' lengths where there is density and it is not constant space
  uint64_t voxelsEvaluated = 0;
  double maximum = 0.0;  // of the densities that rays come near
};

/// depthsAlong() the grid that voxelize() would give, up to the rounding of fields on lattices that begin
/// elsewhere. Takes memory by the rays, not by the grid. The same on any number of threads. Throws
/// VoxelizeError as voxelize() does, but for memory, and for what no ray comes near.
RayDepths depthsAlong(const Field& field, const VoxelizeSettings& settings, std::span<const Chord> chords);

}  // namespace nephele
