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

/// values[n] = distances in cells for n from 0 on, in whole vectors; returns how many that were, at most
/// `count`. Takes the operations of shared::worleyDistances, for noise without a period that does not evolve;
/// values are those of the definition but where rounding decides whether a cell is near enough to matter.
/// Equal bits on every target.
size_t worleyStrewn(const WorleyNoise& noise, const StrewnPlaces& places, size_t count, float* values);

}  // namespace nephele
