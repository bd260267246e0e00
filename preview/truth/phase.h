// The path tracer's own Henyey–Greenstein phase function: a second witness beside the shared text. `along` is
// the direction of flight before, `next` after, both seen along the camera's path: g > 0 goes on forwards.
// Depends on GLM.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace nephele::truth {

/// Two lobes of Henyey–Greenstein, mixed: (1 − share) · HG(first) + share · HG(second); |first|, |second| <
/// 1, share in [0, 1]. One lobe where share is 0.
struct PhaseFunction {
  float first = 0.0f, second = 0.0f, share = 0.0f;

  /// Per steradian, for unit vectors; integrates to 1 over the sphere [MODEL.md, 2].
  float density(const glm::vec3& along, const glm::vec3& next) const;
  /// A unit vector with that density, from two numbers in [0, 1) (inverse of the distribution of the cosine
  /// [PBRT, 11.3.1], in double precision).
  glm::vec3 sample(const glm::vec3& along, float u1, float u2) const;
};

/// The unit vector with this cosine and sine to `axis` (unit), at an angle about it of `turn` full turns.
glm::vec3 directionAround(const glm::vec3& axis, float cosine, float sine, float turn);

}  // namespace nephele::truth
