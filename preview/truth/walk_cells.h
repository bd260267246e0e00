// A walk along a ray through the cells of a control grid, in order. Depends on preview/truth/control_grid.h.
#pragma once

#include <algorithm>
#include <cmath>

#include "preview/truth/tracking.h"

namespace nephele::truth {

/// Calls visit(cell, t0, t1) for each cell with density that the ray crosses between its origin, which lies
/// in the grid, and its reach; t0 ≤ t1. Ends where visit returns false. Amanatides and Woo (1987); each
/// face's distance is computed afresh, so that nothing adds up.
template <class Visit>
inline void walkCells(const ControlGrid& grid, const TrackedRay& ray, Visit&& visit) {
  // Slower components cross no face within a float's range of distances.
  constexpr float kStill = 1e-30f;
  const float edge = static_cast<float>(grid.edge);
  const std::ptrdiff_t strides[3] = {1, grid.count.x, std::ptrdiff_t{grid.count.x} * grid.count.y};
  float face[3], faceStep[3], inverse[3], offset[3], next[3];
  std::ptrdiff_t stride[3], at = 0;
  int left[3];  // cells until the grid ends
  for (int axis = 0; axis < 3; ++axis) {
    const int count = grid.count[axis];
    const int cell = std::clamp(static_cast<int>(ray.origin[axis] / edge), 0, count - 1);
    const float d = ray.direction[axis];
    const bool forward = d > 0.0f, still = std::abs(d) < kStill;
    at += cell * strides[axis];
    stride[axis] = forward ? strides[axis] : -strides[axis];
    left[axis] = forward ? count - cell : cell + 1;
    face[axis] = static_cast<float>(forward ? cell + 1 : cell) * edge;
    faceStep[axis] = forward ? edge : -edge;
    inverse[axis] = still ? 0.0f : 1.0f / d;
    offset[axis] = still ? std::numeric_limits<float>::infinity() : -ray.origin[axis] * inverse[axis];
    next[axis] = face[axis] * inverse[axis] + offset[axis];
  }
  const uint32_t* index = grid.index.data();
  const ControlCell* cells = grid.cells.data();
  for (float t = 0.0f;;) {
    int axis = next[0] < next[1] ? 0 : 1;
    if (next[2] < next[axis]) axis = 2;
    const float exit = std::max(t, std::min(next[axis], ray.reach));
    if (const uint32_t entry = index[at]; entry != 0 && !visit(cells[entry - 1], t, exit)) return;
    if (!(next[axis] < ray.reach) || --left[axis] == 0) return;
    t = exit;
    at += stride[axis];
    face[axis] += faceStep[axis];
    next[axis] = face[axis] * inverse[axis] + offset[axis];
  }
}

}  // namespace nephele::truth
