// Packing of boxes with few sizes into a box of texels. Depends on nothing of ours.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace nephele {

/// Where boxes lie: in slabs across z of one thickness, in slabs in rows of one height, in rows side by side.
struct Packing {
  glm::ivec3 size{1};               // of what holds them all
  std::vector<glm::ivec3> corners;  // of each box
  std::vector<size_t> order;        // the boxes from slab to slab, z rising
};

/// Packs boxes, each of whose sides is one of a few small numbers, into at most `limit` texels an axis; of
/// the widths and heights tried, those that leave the least unused. The same boxes give the same packing.
/// Nothing where they do not fit. No boxes take one texel.
std::optional<Packing> packBoxes(const std::vector<glm::ivec3>& sizes, int limit);

}  // namespace nephele
