// A noise that fractal sums are built over: gradient, value or cellular, one octave at a time. Depends on
// perlin.h, the kernels and shared text.
#pragma once

#include <string>

#include "bake/fields/perlin.h"
#include "bake/fields/worley_kernels.h"

namespace nephele {

/// perlin and value give [−1, 1]; worley gives clamp(1 − 2 F1, −1, 1): 1 at feature points.
enum class Basis { perlin, value, worley };

/// "perlin", "value", "worley".
Basis basisOf(const std::string& name);

/// What a fractal sum does to each octave N: fBm N; ridged 1 − |N|; billow |N|.
enum class Fold { plain, ridged, billow };

/// Mean of a folded octave, that stands in for octaves that the grid cannot hold, so that leaving them out
/// does not change the level. From 4 million samples: E|N| is 0.2124 for gradient noise, 0.3303 for value
/// noise; for worley E N = −0.041, E|N| = 0.282 (each ± 0.001).
double meanOf(Basis basis, Fold fold);

/// Largest slope of value noise per cell, in any direction: fade' ≤ 1.875 on each axis, values up to 2 apart;
/// the steepest place mixes the three axes no steeper than one alone, since the other weights then lie
/// between.
inline constexpr double kValueSlope = 1.875 * 2.0;

/// values[n] = N of one octave (its weight is not used).
void evaluateBasis(Basis basis, const NoiseOctave& octave, const Points& points, float* values);
void evaluateBasis(Basis basis, const NoiseOctave& octave, const Lattice& lattice, float* values);
Interval boundBasis(Basis basis, const NoiseOctave& octave, const Box& box);

}  // namespace nephele
