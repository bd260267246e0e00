// Gradient noise of many octaves as a building block of fields: octaves, bounds, band limit. Values come from
// noise_kernels.h. Depends on field.h, motion.h and shared text.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/fields/field.h"
#include "bake/fields/motion.h"
#include "bake/fields/table.h"

namespace nephele {

/// One octave: `weight` times gradient noise of cells of `cellSize` world units.
struct NoiseOctave {
  double cellSize = 1.0;
  float weight = 1.0f;
  uint32_t seed = 0;
  int period = 0;          // cells; 0: none
  glm::dvec3 offset{0.0};  // world units that the pattern has moved
  Turn turn{};
};

/// What the octave's noise is multiplied by besides its weight, so that it stays in [−1, 1].
float noiseScale(const NoiseOctave& octave);

/// The definition at the place f in [0, 1]³ of a cell: shared::perlinNoise, or turningNoise where it evolves.
float noiseInCell(const NoiseOctave& octave, const glm::ivec3& cell, const glm::vec3& f);

/// Weight of a noise whose cells measure `cellVoxels` voxels: 1 from 4 voxels on, 0 below 2, linear between.
/// A grid cannot hold a wave shorter than two voxels; it would alias.
double bandLimit(double cellVoxels);

/// Largest slope of perlinNoise per cell, in any direction: 3.75 · kPerlinScale. The supremum over positions
/// and the 12 gradients of each corner lies at a cell's centre, where fade' = 1.875 meets differences of 2.
/// Gradients that turn in their planes reach the same 3.75 there, under a smaller scale.
inline constexpr double kPerlinSlope = 3.75 * 0.96487842532;
/// The same along (1, 1, 1) for a displacement of one cell on each axis: 5.396 · kPerlinScale
/// (supremum 5.39573), and 5.681 · kTurningScale (supremum 5.68060).
inline constexpr double kPerlinCornerSlope = 5.396 * 0.96487842532;
inline constexpr double kTurningCornerSlope = 5.681 * 0.9628345;

/// Bounds of octave.weight · noise over a finite box: ± weight, or tighter about the centre's value where the
/// box is small.
Interval boundNoise(const NoiseOctave& octave, const Box& box);

/// A fractal sum: Σ gain^i N_i(p · lacunarity^i) / Σ gain^i.
struct Fractal {
  double cellSize = 1.0;  // of the first octave, world units
  int64_t octaves = 5;
  double lacunarity = 2.0;
  double gain = 0.5;
  int64_t period = 0;  // cells of the first octave; 0: none
  uint32_t seed = 0;
  glm::dvec3 scroll{0.0};  // as in Motion
  glm::dvec3 fineScroll{0.0};
  double evolve = 0.0;

  Motion motion() const;
};

/// Its octaves at the context's time, each faded by the band limit; the divisor of the weights counts all
/// octaves asked for. What was weakened or left out is noted in the context under `field`.
std::vector<NoiseOctave> fbmOctaves(const Fractal& fractal, const BuildContext& context, const char* field);

}  // namespace nephele
