// How far two bakes of one asset are apart: the seam of a loop. Depends on voxelize_grid.h, OpenVDB.
#include <algorithm>
#include <cmath>

#include "bake/voxelize.h"
#include "bake/voxelize_grid.h"

namespace nephele {
namespace {

/// Largest difference at the active voxels of `a`.
double largestOver(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
  double largest = 0.0;
  const auto accessor = b.getConstAccessor();
  for (auto value = a.tree().cbeginValueOn(); value; ++value) {
    const double here = double(*value);
    if (value.isVoxelValue()) {
      largest = std::max(largest, std::abs(here - double(accessor.getValue(value.getCoord()))));
      continue;
    }
    const openvdb::CoordBBox box = value.getBoundingBox();
    for (auto at = box.begin(); at; ++at)
      largest = std::max(largest, std::abs(here - double(accessor.getValue(*at))));
  }
  return largest;
}

}  // namespace

double largestDifference(const Voxelized& a, const Voxelized& b) {
  return std::max(largestOver(*a.grid->grid, *b.grid->grid), largestOver(*b.grid->grid, *a.grid->grid));
}

}  // namespace nephele
