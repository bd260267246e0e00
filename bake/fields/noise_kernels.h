// Gradient noise by SIMD, on lattice blocks and at points, with run-time dispatch. Every target gives equal
// bits: no fused multiply-add, one order of operations. Depends on perlin.h's octaves alone; Highway stays
// behind.
#pragma once

#include <cstddef>

#include "bake/fields/perlin.h"

namespace nephele {

/// Adds Σ octave.weight · noise on the block to sums[512], ordered as the block. Differs from
/// shared::perlinNoise by at most 4e-6 (rounding of a place in its cell). Octaves of cells smaller than two
/// spacings are legal and take the way by points.
void addNoiseOnLattice(const NoiseOctave* octaves, size_t count, const Lattice& lattice, float* sums);

/// Adds Σ octave.weight · noise at each point to sums[points.count], octave by octave: equal to
/// shared::perlinNoise at the place in its cell. Fastest where points lie near each other.
void addNoiseAtPoints(const NoiseOctave* octaves, size_t count, const Points& points, float* sums);

}  // namespace nephele
