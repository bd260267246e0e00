// The voxeliser against the plainest one: every voxel of the box, one at a time. And its promises: same on
// any number of threads, nothing outside, refusals with numbers.
#include "bake/voxelize.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>

#include "tests/bake/field_samples.h"
#include "volume/bricks.h"

namespace nephele::test {
namespace {

constexpr double kVoxel = 0.04;

FieldPtr cloud() {
  const auto list = [](FieldPtr a, FieldPtr b) {
    return Value{std::vector<FieldPtr>{std::move(a), std::move(b)}};
  };
  const FieldPtr lifted = makeField(
      "add",
      {{"inputs", list(makeField("fbm", {{"cell_size", 0.5}}), makeField("constant", {{"value", 0.1}}))}});
  return makeField("warp",
                   {{"input", makeField("multiply", {{"inputs", list(makeField("sphere"), lifted)}})}});
}

/// Writes and reads back as bricks, so that the test sees what a reader of the file sees.
BrickVolume baked(const Field& field, const VoxelizeSettings& settings) {
  const std::string path = (std::filesystem::temp_directory_path() / "nephele_voxelize_test.vdb").string();
  writeDensity(path, voxelize(field, settings), Provenance{});
  BrickVolume bricks = loadBricks(path);
  std::filesystem::remove(path);
  return bricks;
}

TEST(Voxelize, HoldsEveryVoxelThatExceedsTheCutoffAndNoOther) {
  const FieldPtr field = cloud();
  const VoxelizeSettings settings{kVoxel, 0.01, false};
  const BrickVolume bricks = baked(*field, settings);
  uint64_t active = 0;
  constexpr int kReach = 50;  // 2 units: the ball of 1 and a displacement of 0.8
  for (int x = -kReach; x <= kReach; ++x)
    for (int y = -kReach; y <= kReach; ++y)
      for (int z = -kReach; z <= kReach; ++z) {
        const double exact = double(valueAt(*field, glm::dvec3(x, y, z) * kVoxel));
        // Blocks and points may differ by rounding, which decides near the cutoff.
        if (std::abs(exact - 0.01) < 1e-4) continue;
        const double stored = densityAt(bricks, glm::dvec3(x, y, z));
        ASSERT_NEAR(stored, exact > 0.01 ? exact : 0.0, 5e-5) << x << ' ' << y << ' ' << z;
        active += exact > 0.01;
      }
  EXPECT_GT(active, 5000u);
  EXPECT_NEAR(double(bricks.activeVoxels), double(active), 0.01 * double(active));
}

TEST(Voxelize, IsTheSameOnAnyNumberOfThreads) {
  const FieldPtr field = cloud();
  std::string hashes[2];
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    hashes[threads - 1] = contentHashOf(voxelize(*field, {kVoxel, 0.001, true}));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0], contentHashOf(voxelize(*field, {kVoxel, 0.002, true})))
      << "the hash sees no difference";
}

TEST(Voxelize, EvaluatesLittleMoreThanItKeeps) {
  // A ball of 0.2 in one corner of a large hull: 2 balls 4 apart.
  const FieldPtr a =
      makeField("sphere", {{"center", std::array<double, 3>{-2, -2, -2}}, {"radius", 0.2}, {"falloff", 0.0}});
  const FieldPtr b =
      makeField("sphere", {{"center", std::array<double, 3>{2, 2, 2}}, {"radius", 0.2}, {"falloff", 0.0}});
  const FieldPtr both = makeField("max", {{"inputs", std::vector<FieldPtr>{a, b}}});
  const Voxelized result = voxelize(*both, {0.01, 0.001, true});
  EXPECT_GT(result.voxelsActive, 60000u);
  EXPECT_LT(result.voxelsEvaluated, 3u * result.voxelsActive);
}

TEST(Voxelize, ReportsTheMassOfABall) {
  const FieldPtr ball = makeField("sphere", {{"radius", 1.0}, {"falloff", 1.0}});
  const Voxelized result = voxelize(*ball, {0.02, 0.0, false});
  // ∫ (1 − r) 4πr² dr = π/3.
  EXPECT_NEAR(result.mass, 3.14159265358979 / 3.0, 1e-3);
  // Above ½ remains the ball of radius ½: ∫ (1 − r) 4πr² dr up to ½ = π (1/6 − 1/16).
  EXPECT_NEAR(voxelize(*ball, {0.02, 0.5, false}).mass, 3.14159265358979 * (1.0 / 6.0 - 1.0 / 16.0), 5e-3);
}

TEST(Voxelize, RoundsToHalfBeforeHashing) {
  const FieldPtr field = cloud();
  const VoxelizeSettings half{kVoxel, 0.001, true};
  const BrickVolume bricks = baked(*field, half);
  const BrickVolume exact = baked(*field, {kVoxel, 0.001, false});
  double largest = 0.0;
  for (int n = 0; n < 5000; ++n) {
    const glm::dvec3 at(n % 17 - 8, n % 31 - 15, n % 23 - 11);
    const double e = densityAt(exact, at);
    if (e > 0.0) largest = std::max(largest, std::abs(densityAt(bricks, at) - e) / e);
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LE(largest, 4.9e-4);
}

TEST(Voxelize, AnEmptyDensityGivesAnEmptyGrid) {
  const FieldPtr faint = makeField(
      "multiply",
      {{"inputs", std::vector<FieldPtr>{makeField("sphere"), makeField("constant", {{"value", 1e-4}})}}});
  EXPECT_EQ(voxelize(*faint, {0.1, 0.001, true}).voxelsActive, 0u);
}

void expectRefusal(const Field& field, const VoxelizeSettings& settings, const std::string& sentence) {
  try {
    voxelize(field, settings);
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const VoxelizeError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  }
}

TEST(Voxelize, RefusesWhatCannotBeBaked) {
  expectRefusal(*makeField("fbm"), {0.1, 0.001, true}, "fills all of space");
  expectRefusal(*makeField("sphere", {{"radius", 1e4}}), {0.01, 0.001, true}, "8e+18 voxels");
  expectRefusal(*makeField("sphere", {{"center", std::array<double, 3>{1e9, 0, 0}}}), {0.1, 0.001, true},
                "beyond 2^30");
  const FieldPtr loud = makeField(
      "multiply",
      {{"inputs", std::vector<FieldPtr>{makeField("sphere"), makeField("constant", {{"value", 1e5}})}}});
  expectRefusal(*loud, {0.1, 0.001, true}, "more than half precision holds");
  EXPECT_GT(voxelize(*loud, {0.1, 0.001, false}).maximum, 9e4);
}

}  // namespace
}  // namespace nephele::test
