// The octaves' factors by the height of the sun: those fitted to one light do not hold under another, least
// of all in layers. Depends on scene.h and GLM.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace nephele {

using OctaveFactors = std::array<double, 4>;  // a, b, c, d, each in [0, 1]
inline constexpr size_t kOpenness = 3;        // the place of d

/// Heights of the sun that factors are fitted at: degrees above the horizon, or below it.
inline constexpr std::array<double, 3> kFittedElevations{5.0, 25.0, 60.0};

/// Factors at each of kFittedElevations.
using SunFactors = std::array<OctaveFactors, kFittedElevations.size()>;

/// Those for a sun at `elevation`, degrees of either sign: linear between the heights of kFittedElevations,
/// and as at the nearest of them beyond.
OctaveFactors factorsAt(const SunFactors& factors, double elevation);

/// Of the scene's brightest sun (by the sum of its channels), degrees above the horizon of `up` (unit); the
/// middle one of kFittedElevations where the scene has no sun.
double sunElevation(const Scene& scene, const glm::dvec3& up);

}  // namespace nephele
