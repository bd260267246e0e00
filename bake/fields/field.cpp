// Boxes, and the way from lattice blocks to points that every field has. Depends on field.h alone.
#include "bake/fields/field.h"

#include <algorithm>
#include <glm/common.hpp>

namespace nephele {

Box nothing() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
}

Box intersection(const Box& a, const Box& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

Box hull(const Box& a, const Box& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

Box grown(const Box& box, double by) { return {box.low - by, box.high + by}; }

Box roundedOutwards(const Box& box) {
  constexpr double kFourUlps = 1.0 / double(uint64_t{1} << 50);
  return {box.low - kFourUlps * glm::abs(box.low), box.high + kFourUlps * glm::abs(box.high)};
}

Box withinMoved(const Box& box, const glm::dvec3& offset) {
  return roundedOutwards({box.low - offset, box.high - offset});
}

LatticePoints::LatticePoints(const Lattice& lattice) : origin(lattice.origin) {
  float along[kBlockEdge];
  for (int n = 0; n < kBlockEdge; ++n) along[n] = float(n * lattice.spacing);
  for (int row = 0; row < kBlockEdge * kBlockEdge; ++row) {
    std::fill_n(x + row * kBlockEdge, kBlockEdge, along[row / kBlockEdge]);
    std::fill_n(y + row * kBlockEdge, kBlockEdge, along[row % kBlockEdge]);
    std::copy_n(along, kBlockEdge, z + row * kBlockEdge);
  }
}

Points LatticePoints::points() const { return {origin, kBlockPoints, x, y, z}; }

void Field::evaluate(const Lattice& lattice, float* values) const {
  const LatticePoints block(lattice);
  evaluate(block.points(), values);
}

}  // namespace nephele
