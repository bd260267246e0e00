// What stands behind voxelize.h's handle. Includes OpenVDB: only bake/voxelize* may include this.
#pragma once

#include "bake/fields/field.h"
#include "volume/vdb_file.h"

namespace nephele {

struct VoxelGrid {
  openvdb::FloatGrid::Ptr grid;
};

struct VelocityGrid {
  openvdb::Vec3SGrid::Ptr grid;
};

/// Makes one leaf out of a tile where there are tiles alone: Blender 3.4 draws nothing then, and the whole
/// grid as soon as there is a leaf.
template <class Tree>
void keepALeaf(Tree& tree) {
  if (tree.leafCount() > 0) return;
  if (const auto tile = tree.cbeginValueOn()) tree.touchLeaf(tile.getCoord());
}

/// Calls visit(origin) for every block of 8 voxels in a cube.
template <class Visit>
void forEachBlock(const openvdb::Coord& origin, int edge, const Visit& visit) {
  for (int x = 0; x < edge; x += kBlockEdge)
    for (int y = 0; y < edge; y += kBlockEdge)
      for (int z = 0; z < edge; z += kBlockEdge) visit(origin.offsetBy(x, y, z));
}

}  // namespace nephele
