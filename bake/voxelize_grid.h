// What stands behind voxelize.h's handle. Includes OpenVDB: only bake/voxelize* may include this.
#pragma once

#include "volume/vdb_file.h"

namespace nephele {

struct VoxelGrid {
  openvdb::FloatGrid::Ptr grid;
};

struct VelocityGrid {
  openvdb::Vec3SGrid::Ptr grid;
};

}  // namespace nephele
