// How far the velocities of one file are from another's, for `diff`. Depends on vdb_file.h and OpenVDB.
#include <algorithm>

#include "volume/difference.h"
#include "volume/vdb_file.h"

namespace nephele {
namespace {

/// The file's grid "vel" of three floats, or an empty one.
openvdb::Vec3SGrid::Ptr velocitiesOf(const std::string& path) {
  openvdb::Vec3SGrid::Ptr found;
  withVdbFile(path, [&](openvdb::io::File& file) {
    if (file.hasGrid("vel")) found = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("vel"));
  });
  return found;
}

/// Largest |vector difference| at the voxels of `a`, and the largest speed there.
void compareAt(const openvdb::Vec3SGrid& a, const openvdb::Vec3SGrid* b, double& largest, double& speed) {
  const auto read = [&](const openvdb::Coord& at) -> openvdb::Vec3d {
    if (!b) return openvdb::Vec3d(0.0);
    const openvdb::Vec3d world = a.transform().indexToWorld(at.asVec3d());
    return openvdb::Vec3d(b->tree().getValue(
        b->transform() == a.transform() ? at : openvdb::Coord::round(b->transform().worldToIndex(world))));
  };
  for (auto value = a.tree().cbeginValueOn(); value; ++value) {
    const openvdb::Vec3d here(*value);
    speed = std::max(speed, here.length());
    const openvdb::CoordBBox box = value.getBoundingBox();
    for (auto at = box.begin(); at; ++at) largest = std::max(largest, (here - read(*at)).length());
  }
}

}  // namespace

void compareVelocities(const std::string& pathA, const std::string& pathB, GridDifference& d) {
  const openvdb::Vec3SGrid::Ptr a = velocitiesOf(pathA), b = velocitiesOf(pathB);
  double speedB = 0.0;
  if (a) compareAt(*a, b.get(), d.largestVelocity, d.largestSpeedA);
  if (b) compareAt(*b, a.get(), d.largestVelocity, speedB);
  d.velocities = a || b;
}

}  // namespace nephele
