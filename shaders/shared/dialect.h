// The C++ half of the dialect in which shared texts are written (the GLSL half is shaders/dialect.glsl).
// Include this before a shared text, at namespace scope. Depends on GLM alone.
#pragma once

#include <glm/glm.hpp>

// Rules of the dialect: these macros for what the languages spell differently; `f` on every float literal;
// explicit conversions; no gl_*, no textures, no uniforms; shared texts include nothing.
#define NPH_FN inline
#define NPH_CONST static constexpr
#define NPH_OUT(type) type&
#define NPH_INOUT(type) type&

namespace nephele::shared {
using glm::abs, glm::ceil, glm::clamp, glm::cross, glm::dot, glm::exp, glm::exp2, glm::floor, glm::length,
    glm::max, glm::min, glm::mix, glm::normalize, glm::sqrt, glm::cos, glm::sin, glm::log, glm::pow;
using glm::bvec3, glm::ivec2, glm::ivec3, glm::ivec4, glm::uint, glm::uvec2, glm::vec2, glm::vec3, glm::vec4;
using glm::uintBitsToFloat;
}  // namespace nephele::shared
