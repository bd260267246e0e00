// Volumes by formulas for the previewer's tests. Depends on volume/bricks.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "volume/bricks.h"

namespace nephele::testing_clouds {

/// A dense box of `size` samples by a formula of the index position.
inline BrickVolume volumeOf(const glm::ivec3& size, const glm::ivec3& origin,
                            const glm::dmat4& worldFromIndex,
                            const std::function<double(const glm::dvec3&)>& density) {
  std::vector<float> values;
  values.reserve(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z));
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        values.push_back(static_cast<float>(density(glm::dvec3(origin + glm::ivec3(x, y, z)))));
  return bricksFromDense(values, size, origin, worldFromIndex);
}

/// Waves cut off at 0 inside a ball about `centre`: bumpy, with holes.
inline double cloudDensity(const glm::dvec3& p, const glm::dvec3& centre, double radius) {
  const double ball = 1.0 - glm::length(p - centre) / radius;
  const double waves = std::sin(0.31 * p.x + 1.1) * std::sin(0.27 * p.y + 0.4) * std::sin(0.35 * p.z + 2.0) +
                       0.5 * std::sin(0.83 * p.x + 0.61 * p.y) * std::sin(0.77 * p.z - 0.53 * p.y);
  return ball <= 0.0 ? 0.0 : std::max(0.0, ball + 0.6 * waves);
}

}  // namespace nephele::testing_clouds
