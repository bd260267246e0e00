// The shared text of particle motion as C++: parameters in nephele::motion, the functions inside struct
// Motion, whose member `particles` stands for GLSL's uniform block. A namespace of its own, since fields and
// light include some of these texts too. Depends on shaders/shared and GLM alone.
#pragma once

#include <cstddef>

#include "shaders/shared/dialect.h"

namespace nephele::motion {
using glm::abs, glm::cross, glm::dot, glm::floor, glm::length, glm::max, glm::min, glm::normalize, glm::sqrt;
using glm::ivec3, glm::ivec4, glm::uint, glm::uintBitsToFloat, glm::vec2, glm::vec3, glm::vec4;

#include "shaders/shared/math.glsl"
#include "shaders/shared/noise.glsl"
#include "shaders/shared/particles_parameters.glsl"
#include "shaders/shared/random.glsl"

// std140 puts every member on a multiple of 16 bytes, and the structs go up by memcpy.
inline constexpr size_t kRowBytes = 16;
inline constexpr size_t kRowsBeforeCurves = 9;
static_assert(sizeof(EmitterParameters) == 7 * kRowBytes);
static_assert(sizeof(VortexParameters) == 2 * kRowBytes && sizeof(AttractorParameters) == 2 * kRowBytes);
static_assert(offsetof(ParticleParameters, sizeCurve) == kRowsBeforeCurves * kRowBytes);
static_assert(sizeof(ParticleParameters) ==
              (kRowsBeforeCurves + 2 * kMaxCurvePoints + 2 * kMaxVortices + 2 * kMaxAttractors) * kRowBytes);

struct Motion {
  ParticleParameters particles;

#include "shaders/shared/particles.glsl"
};

}  // namespace nephele::motion
