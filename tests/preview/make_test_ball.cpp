// make_test_ball FILE.vdb: a lopsided fog ball for tests of the programs. Depends on volume.
#include <cmath>

#include "volume/vdb_file.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  nephele::initializeOpenVdb();
  constexpr double kVoxel = 0.1;
  constexpr int kReach = 20;
  auto grid = nephele::makeFogGrid("density", kVoxel, false);
  auto accessor = grid->getAccessor();
  for (int z = -kReach; z <= kReach; ++z)
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x) {
        const double r = std::sqrt(x * x + y * y + z * z) / kReach;
        const double value = (1.0 - r) * (x > 0 ? 2.0 : 0.5) * (z > 5 && y > 3 ? 3.0 : 1.0);
        if (value > 0.0) accessor.setValue({x, y, z}, static_cast<float>(value));
      }
  nephele::writeVdb(argv[1], {grid}, {});
  return 0;
}
