// Where a world coordinate lies on a noise lattice. Depends on nothing.
#pragma once

#include <cmath>
#include <cstdint>

namespace nephele {

/// A lattice cell and the place in it, in [0, 1]. Cells wrap at 2^32: noise repeats there, 4 billion cells
/// away.
struct CellPlace {
  int32_t cell;
  float fraction;
};

inline CellPlace cellPlace(double coordinate, double cellSize) {
  const double cells = coordinate / cellSize;
  const double whole = std::floor(cells);
  return {int32_t(uint32_t(int64_t(whole))), float(cells - whole)};
}

/// A cell further on by a whole float, wrapping at 2^32.
inline int32_t cellAfter(int32_t cell, float by) { return int32_t(uint32_t(cell) + uint32_t(int32_t(by))); }

}  // namespace nephele
