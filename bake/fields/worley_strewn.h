// Cellular noise at points strewn over many cells, as under a wild warp, by SIMD over points with run-time
// dispatch. A part of worley_kernels; Highway stays behind.
#pragma once

#include "bake/fields/worley_kernels.h"

namespace nephele {

/// Places in cells relative to the lattice cell (cellX, cellY, cellZ).
struct StrewnPlaces {
  int32_t cellX, cellY, cellZ;
  const float *x, *y, *z;
};

/// Where the origin of a distance's floats lies: in the cell of each point, as the definition has it, or in
/// the first cell, as features gathered for many points have it. It decides the last bits alone.
enum class Frame { ownCell, firstCell };

/// values[n] = distances in cells at `count` places, whose arrays go on for 15 more floats. For noise without
/// a period that does not evolve. Values are those over all feature points, in the operations of
/// shared::worleyDistances: equal bits on every target, and equal to those from worley_kernels' gathered
/// features in their frame. False, and nothing done, on a machine without vectors.
bool worleyStrewn(const WorleyNoise& noise, const StrewnPlaces& places, Frame frame, size_t count,
                  float* values);

}  // namespace nephele
