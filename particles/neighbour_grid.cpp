// A hashed uniform grid by counting sort. Depends on neighbour_grid.h.
#include "particles/neighbour_grid.h"

#include <bit>
#include <cmath>

namespace nephele {

NeighbourGrid::NeighbourGrid(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                             float reach)
    : x_(x), y_(y), z_(z), reach_(reach) {
  mask_ = std::bit_ceil(uint32_t(x.size()) + 1) - 1;
  starts_.assign(size_t(mask_) + 2, 0);
  for (size_t i = 0; i < x.size(); ++i) ++starts_[bucketOf(cellOf(i)) + 1];
  for (size_t n = 1; n < starts_.size(); ++n) starts_[n] += starts_[n - 1];
  order_.resize(x.size());
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (size_t i = 0; i < x.size(); ++i) order_[next[bucketOf(cellOf(i))]++] = uint32_t(i);
}

glm::ivec3 NeighbourGrid::cellOf(size_t i) const {
  return {int(std::floor(x_[i] / reach_)), int(std::floor(y_[i] / reach_)), int(std::floor(z_[i] / reach_))};
}

uint32_t NeighbourGrid::bucketOf(const glm::ivec3& cell) const {
  // Three large primes [Teschner 2003].
  uint32_t h = uint32_t(cell.x) * 73856093u ^ uint32_t(cell.y) * 19349663u ^ uint32_t(cell.z) * 83492791u;
  h ^= h >> 15;
  return h & mask_;
}

}  // namespace nephele
