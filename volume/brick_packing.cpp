// Shelves of boxes. Depends on nothing of ours.
#include "volume/brick_packing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace nephele {
namespace {

/// Places one box after the other; sizes come thickest first, in those highest, in those widest.
class Shelves {
 public:
  Shelves(int width, int height) : width_(width), height_(height) {}

  /// Places up to `count` boxes of one size side by side where there is room; returns how many, at least 1.
  int64_t place(const glm::ivec3& size, int64_t count, glm::ivec3& corner) {
    if (size.z != size_.z || size.y != size_.y || at_.x + size.x > width_) nextRow(size);
    corner = at_;
    const int64_t fit = std::min<int64_t>(count, (width_ - at_.x) / size.x);
    at_.x += static_cast<int>(fit) * size.x;
    return fit;
  }
  int depth() const { return at_.z + size_.z; }

 private:
  void nextRow(const glm::ivec3& size) {
    at_.x = 0;
    at_.y += size_.y;
    if (size.z != size_.z || at_.y + size.y > height_) {
      at_.y = 0;
      at_.z += size_.z;
    }
    size_ = size;
  }

  int width_, height_;
  glm::ivec3 at_{0}, size_{0};
};

auto rank(const glm::ivec3& size) { return std::tuple(-size.z, -size.y, -size.x); }

}  // namespace

std::optional<Packing> packBoxes(const std::vector<glm::ivec3>& sizes, int limit) {
  Packing packing;
  if (sizes.empty()) return packing;
  packing.order.resize(sizes.size());
  std::iota(packing.order.begin(), packing.order.end(), size_t{0});
  std::stable_sort(packing.order.begin(), packing.order.end(),
                   [&](size_t a, size_t b) { return rank(sizes[a]) < rank(sizes[b]); });
  std::map<std::tuple<int, int, int>, int64_t> counts;
  int64_t texels = 0;
  for (const glm::ivec3& size : sizes) {
    ++counts[rank(size)];
    texels += int64_t{size.x} * size.y * size.z;
  }
  const int edge = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(texels))));
  int64_t least = std::numeric_limits<int64_t>::max();
  glm::ivec3 best(0);
  const auto attempt = [&](int width, int height) {
    Shelves shelves(width, height);
    glm::ivec3 corner;
    for (const auto& [key, count] : counts) {
      const glm::ivec3 size(-std::get<2>(key), -std::get<1>(key), -std::get<0>(key));
      if (size.x > width || size.y > height) return;
      for (int64_t left = count; left > 0;) left -= shelves.place(size, left, corner);
    }
    const int64_t taken = int64_t{width} * height * shelves.depth();
    if (shelves.depth() > limit || taken >= least) return;
    least = taken;
    best = {width, height, shelves.depth()};
  };
  // Flat boxes waste less in their last slab, deep ones more at their sides.
  constexpr int kReach = 64;
  const int middle = std::clamp(edge * 3 / 4, 1, limit);
  const int from = std::max(1, middle - kReach / 2), to = std::min(limit, middle + kReach / 2);
  for (int height = from; height <= to; ++height)
    for (int width = from; width <= to; ++width) attempt(width, height);
  attempt(limit, limit);
  if (best.x == 0) return std::nullopt;
  packing.size = best;
  packing.corners.resize(sizes.size());
  Shelves shelves(best.x, best.y);
  for (const size_t box : packing.order) shelves.place(sizes[box], 1, packing.corners[box]);
  return packing;
}

}  // namespace nephele
