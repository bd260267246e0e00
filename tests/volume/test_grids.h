// Grids that the tests of volume write and read. May include OpenVDB, as volume itself.
#pragma once

#include <openvdb/openvdb.h>

#include <random>
#include <string>

#include "volume/vdb_file.h"

namespace nephele {

/// A box of random values in (0, 1), `size` voxels along each axis from `origin` on; the same for the same
/// seed.
inline openvdb::FloatGrid::Ptr randomGrid(const openvdb::Coord& origin, int size, unsigned seed = 1) {
  auto grid = makeFogGrid("density", 0.1, false);
  auto accessor = grid->getAccessor();
  std::mt19937 random(seed);
  constexpr float kScale = 1.0f / 4294967296.0f;  // of 32 random bits
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z)
        accessor.setValue(origin.offsetBy(x, y, z), (static_cast<float>(random()) + 1.0f) * kScale);
  return grid;
}

inline void write(const std::string& path, const openvdb::GridBase::Ptr& grid,
                  const Provenance& provenance = {}) {
  writeVdb(path, {grid}, provenance);
}

}  // namespace nephele
