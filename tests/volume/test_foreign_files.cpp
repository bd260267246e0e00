// Files that another program wrote, where they are at hand.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "volume/bricks.h"
#include "volume/info.h"

namespace nephele {
namespace {

class ForeignFile : public testing::TestWithParam<const char*> {};

TEST_P(ForeignFile, LoadsAndAgreesWithItsOwnStatistics) {
  const std::string path = std::string(NEPHELE_TEST_DATA) + "/" + GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "left out: " << path << " is not there";
  const FileInfo info = inspectFile(path);
  ASSERT_EQ(info.grids.size(), 1u);
  const GridInfo& grid = info.grids[0];
  const BrickVolume bricks = loadBricks(path);
  std::cout << GetParam() << ": " << grid.activeVoxels << " active voxels, " << bricks.slotCount()
            << " slots\n";
  EXPECT_EQ(info.metadata.at("creator").rfind("Houdini", 0), 0u);
  EXPECT_EQ(std::to_string(bricks.activeVoxels), grid.metadata.at("file_voxel_count"));
  EXPECT_EQ(bricks.activeVoxels, grid.activeVoxels);
  EXPECT_EQ(bricks.activeMin, grid.boxMin);
  EXPECT_EQ(bricks.activeMax, grid.boxMax);
  EXPECT_EQ(bricks.worldFromIndex, grid.worldFromIndex);
  EXPECT_GT(bricks.meanActive, 0.0);
  EXPECT_LE(bricks.meanActive, bricks.maximum);
  // Every active voxel lies in a stored brick, so the mean over the active box times its size is the sum.
  double sum = 0.0;
  for (int z = grid.boxMin.z; z < grid.boxMax.z; ++z)
    for (int y = grid.boxMin.y; y < grid.boxMax.y; ++y)
      for (int x = grid.boxMin.x; x < grid.boxMax.x; ++x) sum += densityAt(bricks, glm::dvec3(x, y, z));
  const double expected = bricks.meanActive * static_cast<double>(bricks.activeVoxels);
  EXPECT_NEAR(sum, expected, 1e-9 * expected);
}

INSTANTIATE_TEST_SUITE_P(Houdini, ForeignFile, testing::Values("pyro.vdb", "fogTommy.vdb"));

}  // namespace
}  // namespace nephele
