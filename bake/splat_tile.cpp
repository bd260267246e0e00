// The box of filled tiles. Depends on splat_tile.h.
#include "bake/splat_tile.h"

namespace nephele {

openvdb::CoordBBox activeBoxOf(const std::vector<TileResult>& tiles) {
  openvdb::CoordBBox origins, active;
  for (const TileResult& tile : tiles)
    if (!tile.origins.empty()) origins.expand(tile.origins);
  const auto onFace = [&](const openvdb::Coord& low, const openvdb::Coord& high) {
    for (int axis = 0; axis < 3; ++axis)
      if (low[axis] == origins.min()[axis] || high[axis] == origins.max()[axis]) return true;
    return false;
  };
  for (const TileResult& tile : tiles) {
    if (tile.origins.empty() || !onFace(tile.origins.min(), tile.origins.max())) continue;
    for (const auto& [number, leaf] : tile.leaves)
      if (onFace(leaf.density->origin(), leaf.density->origin())) leaf.density->evalActiveBoundingBox(active);
  }
  return active;
}

}  // namespace nephele
