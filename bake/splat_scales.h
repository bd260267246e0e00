// What each particle's kernel is multiplied by, so that its whole mass comes into the grid. Part of splat;
// depends on splat_batch.h, splat_shaped.h, no OpenVDB.
#pragma once

#include <vector>

#include "bake/splat_batch.h"
#include "bake/splat_shaped.h"

namespace nephele {

/// Each particle's mass over the volume of a voxel and the sum of its kernel; below 0 where it is to be kept
/// as a point, since noise left nothing else. Empty where tiles scale all particles themselves.
std::vector<float> splatScales(const SplatParticles& particles, const SplatSettings& settings,
                               const SplatPlaces& places, const SplatSorter& sorter, SplatShaping& shaping);

}  // namespace nephele
