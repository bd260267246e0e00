// Henyey–Greenstein: density and sampling. Depends on GLM.
#include "preview/truth/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nephele::truth {

using glm::vec3;

namespace {

/// 1 − |g| cosθ is taken from the difference of the vectors, which keeps its digits where they nearly agree.
float lobeDensity(const vec3& along, const vec3& next, float g) {
  const float size = std::abs(g);
  const vec3 apart = g < 0.0f ? next + along : next - along;
  // (1 − |g|)² + |g| |apart|² = 1 + g² − 2 g cosθ, since |apart|² = 2 (1 ∓ cosθ).
  const float square = (1.0f - size) * (1.0f - size) + size * glm::dot(apart, apart);
  constexpr float kSphere = 4.0f * std::numbers::pi_v<float>;
  return (1.0f - size) * (1.0f + size) / (kSphere * square * std::sqrt(square));
}

}  // namespace

vec3 directionAround(const vec3& axis, float cosine, float sine, float turn) {
  // Duff et al., "Building an orthonormal basis, revisited" (2017).
  const float sign = std::copysign(1.0f, axis.z);
  const float a = -1.0f / (sign + axis.z), b = axis.x * axis.y * a;
  const vec3 x(1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
  const vec3 y(b, sign + axis.y * axis.y * a, -axis.y);
  const float angle = 2.0f * std::numbers::pi_v<float> * turn;
  return glm::normalize(cosine * axis + sine * (std::cos(angle) * x + std::sin(angle) * y));
}

namespace {

vec3 sampleLobe(const vec3& along, float g, float u1, float u2) {
  const double asymmetry = double{g};
  double cosine = 1.0 - 2.0 * double{u1};
  // Below, the quotient would divide rounding by almost 0, and the lobe is uniform to one part in a million.
  constexpr double kUniform = 1e-6;
  if (std::abs(asymmetry) > kUniform) {
    const double s = (1.0 - asymmetry * asymmetry) / (1.0 + asymmetry * cosine);
    cosine = std::clamp((1.0 + asymmetry * asymmetry - s * s) / (2.0 * asymmetry), -1.0, 1.0);
  }
  const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return directionAround(along, static_cast<float>(cosine), static_cast<float>(sine), u2);
}

}  // namespace

float PhaseFunction::density(const vec3& along, const vec3& next) const {
  if (share <= 0.0f) return lobeDensity(along, next, first);
  return (1.0f - share) * lobeDensity(along, next, first) + share * lobeDensity(along, next, second);
}

vec3 PhaseFunction::sample(const vec3& along, float u1, float u2) const {
  if (u1 < share) return sampleLobe(along, second, u1 / share, u2);
  return sampleLobe(along, first, (u1 - share) / (1.0f - share), u2);
}

}  // namespace nephele::truth
