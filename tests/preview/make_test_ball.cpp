// make_test_ball FILE.vdb [ball [RADIUS] | empty | level_set]: small grids for tests of the programs: a
// lopsided fog ball (radius in voxels, 20 unless given), a fog grid without voxels, a ball's surface. Depends
// on volume.
#include <cmath>
#include <cstdlib>
#include <string>

#include "volume/vdb_file.h"

namespace {

constexpr double kVoxel = 0.1;
constexpr int kReach = 20;

double ballDensity(int x, int y, int z, double radius) {
  const double r = std::sqrt(x * x + y * y + z * z) / radius;
  return (1.0 - r) * (x > 0 ? 2.0 : 0.5) * (z > 5 && y > 3 ? 3.0 : 1.0);
}

openvdb::FloatGrid::Ptr makeBall(double radius) {
  auto grid = nephele::makeFogGrid("density", kVoxel, false);
  auto accessor = grid->getAccessor();
  for (int z = -kReach; z <= kReach; ++z)
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x)
        if (const double value = ballDensity(x, y, z, radius); value > 0.0)
          accessor.setValue({x, y, z}, static_cast<float>(value));
  return grid;
}

openvdb::FloatGrid::Ptr makeSurface() {
  constexpr double kRadius = 10.0, kBand = 3.0;  // voxels
  auto grid = nephele::makeFogGrid("surface", kVoxel, false);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  auto accessor = grid->getAccessor();
  for (int z = -kReach; z <= kReach; ++z)
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x) {
        const double distance = std::sqrt(x * x + y * y + z * z) - kRadius;
        if (std::abs(distance) < kBand) accessor.setValue({x, y, z}, static_cast<float>(kVoxel * distance));
      }
  return grid;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  nephele::initializeOpenVdb();
  const std::string kind = argc > 2 ? argv[2] : "ball";
  openvdb::FloatGrid::Ptr grid;
  if (kind == "ball") grid = makeBall(argc > 3 ? std::atof(argv[3]) : kReach);
  if (kind == "empty") grid = nephele::makeFogGrid("density", kVoxel, false);
  if (kind == "level_set") grid = makeSurface();
  if (!grid) return 2;
  nephele::writeVdb(argv[1], {grid}, {});
  return 0;
}
