// make_test_ball FILE.vdb [ball [RADIUS] | empty | voxel | level_set | five]: small grids for tests of the
// programs: a lopsided fog ball (radius in voxels, 20 unless given), a fog grid without voxels or with one, a
// ball's surface, and a file of a ball, a surface, a velocity and two more balls. Depends on volume.
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

openvdb::FloatGrid::Ptr makeBall(double radius, const char* name = "density") {
  auto grid = nephele::makeFogGrid(name, kVoxel, false);
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

/// The grids that the chooser lists, in this order.
openvdb::GridCPtrVec makeFive() {
  constexpr double kSmoke = 9.0, kFire = 14.0;
  const auto velocity = nephele::makeVelocityGrid(kVoxel, false);
  velocity->getAccessor().setValue({1, 2, 3}, {1.0f, 0.0f, 0.0f});
  return {makeBall(kReach), makeSurface(), velocity, makeBall(kSmoke, "smoke"), makeBall(kFire, "fire")};
}

openvdb::GridCPtrVec gridsOf(const std::string& kind, double radius) {
  if (kind == "ball") return {makeBall(radius)};
  if (kind == "level_set") return {makeSurface()};
  if (kind == "five") return makeFive();
  if (kind != "empty" && kind != "voxel") return {};
  auto grid = nephele::makeFogGrid("density", kVoxel, false);
  if (kind == "voxel") grid->getAccessor().setValue({4, -5, 6}, 1.0f);
  return {grid};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  nephele::initializeOpenVdb();
  const std::string kind = argc > 2 ? argv[2] : "ball";
  const openvdb::GridCPtrVec grids = gridsOf(kind, argc > 3 ? std::atof(argv[3]) : kReach);
  if (grids.empty()) return 2;
  nephele::writeVdb(argv[1], grids, {});
  return 0;
}
