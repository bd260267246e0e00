// Makes the kinds of grid that bakes fill. Alone in their file: FloatGrid::create() is slow to compile.
// Depends on OpenVDB.
#include "base/error.h"
#include "volume/vdb_file.h"

namespace nephele {

openvdb::FloatGrid::Ptr makeFogGrid(const std::string& name, double voxelSize, bool saveAsHalf) {
  NEPHELE_CHECK_GT(voxelSize, 0.0);
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
  grid->setSaveFloatAsHalf(saveAsHalf);
  return grid;
}

openvdb::Vec3SGrid::Ptr makeVelocityGrid(double voxelSize, bool saveAsHalf) {
  NEPHELE_CHECK_GT(voxelSize, 0.0);
  initializeOpenVdb();
  auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  grid->setName("vel");
  grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
  grid->setSaveFloatAsHalf(saveAsHalf);
  return grid;
}

}  // namespace nephele
