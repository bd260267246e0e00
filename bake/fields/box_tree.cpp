// Building a tree of boxes. Depends on box_tree.h alone.
#include "bake/fields/box_tree.h"

#include <algorithm>
#include <numeric>

namespace nephele {
namespace {
constexpr uint32_t kLeafItems = 4;
}

BoxTree::BoxTree(const std::vector<Box>& boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  split(0, 0, uint32_t(items_.size()), boxes);
}

void BoxTree::split(uint32_t node, uint32_t from, uint32_t to, const std::vector<Box>& boxes) {
  Box all = nothing(), centres = nothing();
  for (uint32_t n = from; n < to; ++n) {
    const Box& box = boxes[items_[n]];
    all = hull(all, box);
    centres = hull(centres, {box.centre(), box.centre()});
  }
  nodes_[node].box = all;
  if (to - from <= kLeafItems) {
    nodes_[node].first = from;
    nodes_[node].count = to - from;
    return;
  }
  const glm::dvec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  const uint32_t middle = from + (to - from) / 2;
  // Ties are broken by number, so that every standard library sorts alike.
  std::nth_element(items_.begin() + from, items_.begin() + middle, items_.begin() + to,
                   [&](uint32_t a, uint32_t b) {
                     const double x = boxes[a].centre()[axis], y = boxes[b].centre()[axis];
                     return x < y || (x == y && a < b);
                   });
  const uint32_t children = uint32_t(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  split(children, from, middle, boxes);
  split(children + 1, middle, to, boxes);
}

}  // namespace nephele
