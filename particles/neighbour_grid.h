// Which particles lie within reach of each other: a uniform grid of cells as wide as the reach, hashed.
// Depends on GLM alone.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace nephele {

class NeighbourGrid {
 public:
  /// Places as three arrays of one length, finite, |place/reach| below 2^30; reach > 0.
  NeighbourGrid(std::span<const float> x, std::span<const float> y, std::span<const float> z, float reach);

  /// Calls body(j) for each other particle in the 27 cells round that of particle i, each once, in no order
  /// that means anything.
  template <class Body>
  void around(size_t i, const Body& body) const {
    const glm::ivec3 own = cellOf(i);
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 cell = own + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const uint32_t bucket = bucketOf(cell);
      for (uint32_t at = starts_[bucket]; at < starts_[bucket + 1]; ++at) {
        const uint32_t j = order_[at];
        if (j != i && cellOf(j) == cell) body(j);
      }
    }
  }

 private:
  glm::ivec3 cellOf(size_t i) const;
  uint32_t bucketOf(const glm::ivec3& cell) const;

  std::span<const float> x_, y_, z_;
  float reach_;
  uint32_t mask_ = 0;
  std::vector<uint32_t> starts_, order_;
};

}  // namespace nephele
