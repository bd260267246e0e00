// Bricks against trilinear interpolation written out: dense arrays, grids of leaves, of tiles, rotated and
// empty ones.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "tests/scratch_folder.h"
#include "tests/volume/test_grids.h"
#include "volume/bricks.h"

namespace nephele {
namespace {

/// A dense array with zeros around it, and its trilinear value in the textbook's form.
struct Dense {
  glm::ivec3 size, origin;
  std::vector<float> values;

  double at(int x, int y, int z) const {
    const glm::ivec3 p = glm::ivec3(x, y, z) - origin;
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] < 0 || p[axis] >= size[axis]) return 0.0;
    return double{values[static_cast<size_t>((p.z * size.y + p.y) * size.x + p.x)]};
  }
  double trilinear(const glm::dvec3& p) const {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y)),
              z = static_cast<int>(std::floor(p.z));
    const auto mix = [](double a, double b, double t) { return a * (1.0 - t) + b * t; };
    const auto alongX = [&](int j, int k) { return mix(at(x, j, k), at(x + 1, j, k), p.x - x); };
    const auto alongXy = [&](int k) { return mix(alongX(y, k), alongX(y + 1, k), p.y - y); };
    return mix(alongXy(z), alongXy(z + 1), p.z - z);
  }
};

Dense randomDense(const glm::ivec3& size, const glm::ivec3& origin, double share, unsigned seed) {
  Dense dense{size, origin, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  dense.values.resize(static_cast<size_t>(size.x * size.y * size.z));
  for (float& value : dense.values) {
    const bool filled = double{uniform(random)} < share;
    value = filled ? uniform(random) : 0.0f;
  }
  return dense;
}

void expectTrilinear(const BrickVolume& bricks, const Dense& dense) {
  std::mt19937 random(3);
  const glm::dvec3 low = glm::dvec3(dense.origin) - 3.0, high = glm::dvec3(dense.origin + dense.size) + 2.0;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 p = low + (high - low) * glm::dvec3(uniform(random), uniform(random), uniform(random));
    ASSERT_NEAR(densityAt(bricks, p), dense.trilinear(p), 1e-12) << p.x << ' ' << p.y << ' ' << p.z;
  }
  for (int z = dense.origin.z - 2; z <= dense.origin.z + dense.size.z + 1; ++z)
    for (int y = dense.origin.y - 2; y <= dense.origin.y + dense.size.y + 1; ++y)
      for (int x = dense.origin.x - 2; x <= dense.origin.x + dense.size.x + 1; ++x)
        ASSERT_EQ(densityAt(bricks, glm::dvec3(x, y, z)), dense.at(x, y, z)) << x << ' ' << y << ' ' << z;
}

openvdb::FloatGrid::Ptr gridOf(const Dense& dense) {
  auto grid = makeFogGrid("density", 1.0, false);
  auto accessor = grid->getAccessor();
  size_t i = 0;
  for (int z = 0; z < dense.size.z; ++z)
    for (int y = 0; y < dense.size.y; ++y)
      for (int x = 0; x < dense.size.x; ++x, ++i)
        if (dense.values[i] > 0.0f)
          accessor.setValue({dense.origin.x + x, dense.origin.y + y, dense.origin.z + z}, dense.values[i]);
  return grid;
}

class BricksAtOrigins : public testing::TestWithParam<glm::ivec3> {};

TEST_P(BricksAtOrigins, DenseEqualsTheClosedForm) {
  const Dense dense = randomDense({19, 7, 12}, GetParam(), 1.0, 1);
  expectTrilinear(bricksFromDense(dense.values, dense.size, dense.origin, glm::dmat4(1.0)), dense);
}

TEST_P(BricksAtOrigins, AGridEqualsTheClosedForm) {
  const ScratchFolder scratch;
  const Dense dense = randomDense({19, 7, 12}, GetParam(), 0.05, 2);
  write(scratch.file("a.vdb"), gridOf(dense));
  const BrickVolume bricks = loadBricks(scratch.file("a.vdb"));
  expectTrilinear(bricks, dense);
  double sum = 0.0;
  uint64_t count = 0;
  for (const float value : dense.values) {
    sum += double{value};
    count += value > 0.0f;
  }
  EXPECT_EQ(bricks.activeVoxels, count);
  EXPECT_NEAR(bricks.meanActive, sum / static_cast<double>(count), 1e-12);
  EXPECT_EQ(bricks.maximum, double{*std::max_element(dense.values.begin(), dense.values.end())});
}

INSTANTIATE_TEST_SUITE_P(Origins, BricksAtOrigins,
                         testing::Values(glm::ivec3(0), glm::ivec3(-8), glm::ivec3(-9, 7, 1),
                                         glm::ivec3(8, 1000001, -1), glm::ivec3(-1000003, -16, 15)));

TEST(Bricks, EqualConstantsShareASlotAndEmptyOnesHaveNone) {
  const glm::ivec3 size(41);  // bricks 1…3 of each axis are 0.5 throughout
  const Dense dense{size, glm::ivec3(0), std::vector<float>(41 * 41 * 41, 0.5f)};
  const BrickVolume bricks = bricksFromDense(dense.values, size, dense.origin, glm::dmat4(1.0));
  EXPECT_EQ(bricks.brickMin, glm::ivec3(-1));
  EXPECT_EQ(bricks.brickCount, glm::ivec3(7));
  // 5³ bricks hold 0.5 alone and share one slot; the shell of 7³ − 5³ reaches into zeros.
  EXPECT_EQ(bricks.slotCount(), size_t{1 + 343 - 125});
  EXPECT_EQ(bricks.samples.size(), bricks.slotCount() * 729);
  expectTrilinear(bricks, dense);
  const BrickVolume none =
      bricksFromDense(std::vector<float>(27, 0.0f), glm::ivec3(3), glm::ivec3(5), glm::dmat4(1.0));
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.brickCount, glm::ivec3(0));
  EXPECT_EQ(densityAt(none, glm::dvec3(6.0)), 0.0);
  EXPECT_EQ(densityAt(bricks, glm::dvec3(std::nan(""), 1e300, -1e300)), 0.0);
}

TEST(Bricks, TilesOfAnyLevelCountThroughout) {
  const ScratchFolder scratch;
  const auto grid = makeFogGrid("density", 1.0, false);
  grid->tree().addTile(1, {-8, 0, 0}, 0.5f, true);
  grid->tree().addTile(2, {128, 128, 128}, 2.0f, true);
  grid->tree().addTile(1, {64, 0, 0}, 3.0f, false);  // inactive: background
  ASSERT_EQ(grid->tree().leafCount(), 0u);
  write(scratch.file("a.vdb"), grid);
  const BrickVolume bricks = loadBricks(scratch.file("a.vdb"));
  EXPECT_EQ(bricks.activeVoxels, 512u + 128u * 128u * 128u);
  EXPECT_EQ(bricks.activeMin, glm::ivec3(-8, 0, 0));
  EXPECT_EQ(bricks.activeMax, glm::ivec3(256));
  const auto at = [&](double x, double y, double z) { return densityAt(bricks, glm::dvec3(x, y, z)); };
  EXPECT_EQ(at(-8, 0, 0), 0.5);
  EXPECT_EQ(at(-8.25, 3, 3), 0.375);
  EXPECT_EQ(at(-0.5, 3, 3), 0.25);
  EXPECT_NEAR(at(200.3, 150.7, 255.0), 2.0, 1e-15);
  EXPECT_EQ(at(127.25, 200, 200), 0.5);
  EXPECT_EQ(at(255.25, 255.5, 200), 2.0 * 0.75 * 0.5);
  EXPECT_EQ(at(256, 200, 200), 0.0);
  EXPECT_EQ(at(66, 2, 2), 0.0);
  EXPECT_LT(bricks.slotCount(), size_t{17 * 17 * 17});
}

TEST(Bricks, InactiveVoxelsOfALeafWithActiveOnesCount) {
  const ScratchFolder scratch;
  const auto grid = makeFogGrid("density", 1.0, false);
  grid->tree().setValue({0, 0, 0}, 1.0f);
  grid->tree().setValueOff({3, 0, 0}, 0.5f);
  grid->tree().setValueOff({8, 0, 0}, 4.0f);  // its leaf, a neighbour, has no active voxel
  write(scratch.file("a.vdb"), grid);
  const BrickVolume bricks = loadBricks(scratch.file("a.vdb"));
  EXPECT_EQ(bricks.activeVoxels, 1u);
  EXPECT_EQ(bricks.meanActive, 1.0);
  EXPECT_EQ(densityAt(bricks, {3.0, 0.0, 0.0}), 0.5);
  EXPECT_EQ(densityAt(bricks, {8.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(densityAt(bricks, {7.5, 0.0, 0.0}), 0.0);
}

TEST(Bricks, AreTheSameOnAnyNumberOfThreads) {
  const ScratchFolder scratch;
  const Dense dense = randomDense({60, 50, 40}, {-20, -20, -20}, 0.01, 5);
  write(scratch.file("a.vdb"), gridOf(dense));
  const BrickVolume many = loadBricks(scratch.file("a.vdb"));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const BrickVolume single = loadBricks(scratch.file("a.vdb"));
  EXPECT_EQ(many.index, single.index);
  EXPECT_EQ(many.samples, single.samples);
  EXPECT_EQ(many.meanActive, single.meanActive);
}

TEST(Bricks, TransformsKeepRotationAndTranslation) {
  const ScratchFolder scratch;
  const auto grid = randomGrid({0, 0, 0}, 3);
  // Rows: the images of the axes, then the origin's.
  const openvdb::Vec4d x(0, 2, 0, 0), y(-3, 0, 0, 0), z(0, 0, 0.5, 0), origin(10, 20, 30, 1);
  constexpr bool kAsRows = true;
  const openvdb::Mat4d matrix(x, y, z, origin, kAsRows);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  write(scratch.file("a.vdb"), grid);
  const BrickVolume bricks = loadBricks(scratch.file("a.vdb"));
  const openvdb::Vec3d expected = grid->indexToWorld(openvdb::Vec3d(1, 2, 3));
  const glm::dvec4 world = bricks.worldFromIndex * glm::dvec4(1, 2, 3, 1);
  EXPECT_EQ(world, glm::dvec4(expected.x(), expected.y(), expected.z(), 1.0));
  EXPECT_EQ(world, glm::dvec4(10 - 3 * 2, 20 + 2 * 1, 30 + 0.5 * 3, 1.0));
}

std::string complaintOf(const std::string& path, const std::string& name = {}) {
  try {
    loadBricks(path, name);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Bricks, RefusesWhatCannotBeShown) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.vdb");
  const auto refusal = [&](const openvdb::GridBase::Ptr& grid, const std::string& name = {}) {
    write(path, grid);
    return complaintOf(path, name).substr(0, 400).erase(0, path.size() + 9);  // without "PATH: error: "
  };
  auto grid = randomGrid({0, 0, 0}, 3);
  EXPECT_EQ(refusal(grid, "smoke"), "holds no grid 'smoke'; it holds 'density'");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(refusal(grid), "grid 'density' is a level set: it holds distances to a surface, not density");
  grid->setName("surface");
  EXPECT_EQ(refusal(grid), "holds no float grid that is a fog volume; it holds 'surface'");
  const auto flags = openvdb::GridBase::createGrid(openvdb::BoolGrid::gridType());
  flags->setName("mask");
  EXPECT_EQ(refusal(flags), "holds no float grid that is a fog volume; it holds 'mask'");
  EXPECT_EQ(refusal(flags, "mask"), "grid 'mask' is no float grid but Tree_bool_5_4_3; it holds 'mask'");
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    grid = randomGrid({0, 0, 0}, 3);
    grid->tree().setValue({1, 2, 1}, bad);
    EXPECT_EQ(refusal(grid), "grid 'density' holds a value that is not finite at index position (1, 2, 1)");
  }
  grid = randomGrid({0, 0, 0}, 3);
  grid->tree().setValue({2000000, 2000000, 2000000}, 1.0f);
  EXPECT_NE(refusal(grid).find("an index of its box would take"), std::string::npos);
  grid = randomGrid({0, 0, 0}, 3);
  const openvdb::BBoxd box({0, 0, 0}, {10, 10, 10});
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(box, 0.5, 10.0));
  EXPECT_EQ(refusal(grid), "the transform of grid 'density' is not affine (a frustum?) and is not rendered");
  EXPECT_THROW(loadBricks(scratch.file("missing.vdb")), InputError);
}

TEST(Bricks, NotesSayWhatWasAssumed) {
  const ScratchFolder scratch;
  const auto grid = randomGrid({0, 0, 0}, 3);
  grid->setName("smoke");
  grid->tree().setValue({1, 1, 1}, -2.0f);
  Provenance provenance;
  provenance.upAxis = 'y';
  write(scratch.file("a.vdb"), grid, provenance);
  const BrickVolume bricks = loadBricks(scratch.file("a.vdb"));
  EXPECT_EQ(bricks.upAxis, 'y');
  EXPECT_EQ(bricks.gridName, "smoke");
  EXPECT_EQ(bricks.notes,
            (std::vector<std::string>{"no float grid is named 'density'; showing 'smoke'",
                                      "grid 'smoke' holds negative values (down to -2); they count as 0"}));
  EXPECT_EQ(densityAt(bricks, {1.0, 1.0, 1.0}), 0.0);
  EXPECT_EQ(bricks.metadata.at("creator"), creatorName());
  EXPECT_TRUE(hasFloatGrid(scratch.file("a.vdb"), "smoke"));
  EXPECT_FALSE(hasFloatGrid(scratch.file("a.vdb"), "density"));
  EXPECT_THROW(hasFloatGrid(scratch.file("missing.vdb"), "smoke"), InputError);
  EXPECT_EQ(bricks.metadata.at("class"), "fog volume");
  write(scratch.file("empty.vdb"), makeFogGrid("density", 1.0, false));
  const BrickVolume empty = loadBricks(scratch.file("empty.vdb"));
  EXPECT_TRUE(empty.empty());
  EXPECT_EQ(empty.activeMin, empty.activeMax);
  EXPECT_EQ(empty.notes, std::vector<std::string>{"grid 'density' is empty: there is no density to show"});
}

}  // namespace
}  // namespace nephele
