// A grey medium is tracked in one channel (float), a coloured one in three (vec3): what both need under one
// name. Depends on preview/truth/tracking.h and GLM.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "preview/truth/tracking.h"

namespace nephele::truth {

template <class Value>
Value extinction(const TrackedMedium& medium);
template <>
inline float extinction<float>(const TrackedMedium& medium) {
  return medium.sigmaMax;
}
template <>
inline glm::vec3 extinction<glm::vec3>(const TrackedMedium& medium) {
  return medium.sigmaT;
}

inline float exponential(float x) { return std::exp(x); }
inline glm::vec3 exponential(const glm::vec3& x) { return glm::exp(x); }

/// 1 − e^(−x) for x ≥ 0, with all digits.
inline float absorbed(float x) {
  constexpr float kSmall = 0.05f;  // the series' next term, x⁵/120, is then below a float's rounding
  return x < kSmall ? x * (1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f)))) : 1.0f - std::exp(-x);
}
inline glm::vec3 absorbed(const glm::vec3& x) { return {absorbed(x.x), absorbed(x.y), absorbed(x.z)}; }

inline float smallest(float x) { return x; }
inline float smallest(const glm::vec3& x) { return std::min({x.x, x.y, x.z}); }
inline float largest(float x) { return x; }
inline float largest(const glm::vec3& x) { return std::max({x.x, x.y, x.z}); }
inline float meanOf(float x) { return x; }
inline float meanOf(const glm::vec3& x) { return (x.x + x.y + x.z) * (1.0f / 3.0f); }
// Rounding may carry a density a hair over its bound.
inline float notNegative(float x) { return std::max(x, 0.0f); }
inline glm::vec3 notNegative(const glm::vec3& x) { return glm::max(x, glm::vec3(0.0f)); }

}  // namespace nephele::truth
