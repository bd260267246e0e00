// The voxeliser against the plainest one: every voxel of the box, one at a time. And its promises: same on
// any number of threads, nothing outside, refusals with numbers.
#include "bake/voxelize.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>

#include "tests/bake/field_samples.h"
#include "tests/scratch_folder.h"
#include "volume/bricks.h"
#include "volume/info.h"

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

/// A field without bounds: everything is filled.
class Unbounded final : public Field {
 public:
  explicit Unbounded(FieldPtr field) : field_(std::move(field)) {}
  void evaluate(const Points& points, float* values) const override { field_->evaluate(points, values); }
  void evaluate(const Lattice& lattice, float* values) const override { field_->evaluate(lattice, values); }
  Interval bounds(const Box&) const override { return {-1e30, 1e30}; }
  Box support() const override { return field_->support(); }

 private:
  FieldPtr field_;
};

/// A field between two voxels along each axis, and 0 outside: bounds know both.
class Cropped final : public Field {
 public:
  Cropped(FieldPtr field, double low, double high)
      : field_(std::move(field)), box_{glm::dvec3(low), glm::dvec3(high)} {}
  void evaluate(const Points& points, float* values) const override { field_->evaluate(points, values); }
  Interval bounds(const Box& box) const override {
    constexpr double kRoom = 0.5;  // nearer than the next voxel
    if (intersection(box, grown(box_, kRoom)).empty()) return {0.0, 0.0};
    return field_->bounds(box);
  }
  Box support() const override { return box_; }

 private:
  FieldPtr field_;
  Box box_;
};

/// The largest difference over the voxels of a box that holds all of both.
double largestByVoxel(const BrickVolume& a, const BrickVolume& b) {
  constexpr int kReach = 90;
  double largest = 0.0;
  for (int x = -kReach; x <= kReach; ++x)
    for (int y = -kReach; y <= kReach; ++y)
      for (int z = -kReach; z <= kReach; ++z) {
        const glm::dvec3 at(x, y, z);
        largest = std::max(largest, std::abs(double(densityAt(a, at)) - double(densityAt(b, at))));
      }
  return largest;
}

template <class Call>
void expectSentence(const std::string& sentence, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const VoxelizeError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  }
}

void expectRefusal(const Field& field, const VoxelizeSettings& settings, const std::string& sentence) {
  expectSentence(sentence, [&] { voxelize(field, settings); });
}

void expectDomainRefusal(const Field& field, const VoxelizeSettings& settings, const std::string& sentence) {
  expectSentence(sentence, [&] { checkDomain(field, settings); });
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

FieldPtr denseBox(double edge, double value) {
  const FieldPtr box = makeField(
      "box", {{"size", std::array<double, 3>{edge, edge, edge}}, {"rounding", 0.0}, {"falloff", 0.0}});
  return makeField("multiply",
                   {{"inputs", std::vector<FieldPtr>{box, makeField("constant", {{"value", value}})}}});
}

TEST(Voxelize, ConstantSpaceBecomesTilesWithoutBeingEvaluated) {
  // 512³ voxels on the tree's own borders: 64 tiles of 128³, one of them opened so that there is a leaf.
  const FieldPtr inside = denseBox(1000.0, 0.3);
  const Voxelized result = voxelize(Cropped(inside, -256, 255), {1.0, 0.001, true});
  EXPECT_EQ(result.voxelsActive, 512ull * 512 * 512);
  EXPECT_EQ(result.voxelsEvaluated, 0u);
  EXPECT_LT(result.gridBytes, 4'000'000u);
  EXPECT_EQ(result.longestAxis, 512);
  const ScratchFolder folder;
  writeDensity(folder.file("a.vdb"), result, Provenance{});
  EXPECT_EQ(inspectFile(folder.file("a.vdb")).grids.front().leaves, 1u) << "Blender draws no tiles alone";
  constexpr double kStored = 0.300048828125;  // 0.3 as a half
  EXPECT_EQ(result.maximum, kStored);
  EXPECT_EQ(result.mass, kStored * 512.0 * 512.0 * 512.0);
}

TEST(Voxelize, TilesHaveTheContentOfLeavesThatWerePruned) {
  // Not on the tree's borders: tiles of 8 and 128, and leaves about them.
  const FieldPtr box = denseBox(300.0, 0.3);
  const Unbounded unbounded(box);
  for (const bool half : {true, false}) {
    const VoxelizeSettings settings{1.0, 0.001, half};
    const Voxelized tiles = voxelize(*box, settings), leaves = voxelize(unbounded, settings);
    EXPECT_EQ(contentHashOf(tiles), contentHashOf(leaves));
    EXPECT_EQ(tiles.voxelsActive, 299ull * 299 * 299);
    EXPECT_NEAR(tiles.mass, leaves.mass, 1e-6 * leaves.mass);
    EXPECT_LT(4 * tiles.voxelsEvaluated, leaves.voxelsEvaluated);
  }
}

TEST(Voxelize, ConstantSpaceIsCutAndRefusedAsLeavesAre) {
  EXPECT_EQ(voxelize(*denseBox(100.0, 0.001), {1.0, 0.001, true}).voxelsActive, 0u);
  EXPECT_EQ(voxelize(*denseBox(100.0, 1e-9), {1.0, 0.0, true}).voxelsActive, 0u) << "0 as a half";
  expectRefusal(*denseBox(100.0, 1e5), {1.0, 0.001, true}, "more than half precision holds");
  EXPECT_EQ(voxelize(*denseBox(100.0, 1e5), {1.0, 0.001, false}).maximum, 1e5);
}

TEST(Voxelize, TellsHowAFieldDiffersFromAGrid) {
  const VoxelizeSettings settings{kVoxel, 0.001, true};
  const auto ball = [](double x, double radius) {
    return makeField("sphere",
                     {{"center", std::array<double, 3>{x, 0, 0}}, {"radius", radius}, {"falloff", 0.5}});
  };
  const FieldPtr fields[] = {
      cloud(), ball(0, 1), ball(2, 0.5), denseBox(2.6, 0.5), denseBox(5.2, 0.75), denseBox(1.0, 0.0)};
  for (const FieldPtr& before : fields)
    for (const FieldPtr& after : fields) {
      const Voxelized a = voxelize(*before, settings), b = voxelize(*after, settings);
      const DensityChange change = changeFrom(a, *after, settings);
      EXPECT_EQ(change.contentHash, contentHashOf(b));
      EXPECT_EQ(change.largestDifference, largestByVoxel(bricksOf(a), bricksOf(b)));
      EXPECT_EQ(change.largestDifference == 0.0, before == after);
    }
}

TEST(Voxelize, RefusesWhatMemoryCannotHold) {
  VoxelizeSettings settings{0.01, 0.001, true};
  const FieldPtr ball = makeField("sphere", {{"radius", 1.0}, {"falloff", 1.0}});  // 4.2 M voxels: 18 MB
  settings.memoryBytes = 100'000'000;
  checkDomain(*ball, settings);
  EXPECT_GT(voxelize(*ball, settings).voxelsActive, 4'000'000u);
  settings.memoryBytes = 10'000'000;
  expectDomainRefusal(*ball, settings, "of memory, and 0.01 GB are available; use larger voxels");
  expectRefusal(*ball, settings, "of memory, and 0.01 GB are available; use larger voxels");
  // A grid of velocities beside it counts.
  settings.memoryBytes = 30'000'000;
  EXPECT_NO_THROW(voxelize(*ball, settings));
  settings.bytesBeside = kVelocityLeafBytes;
  expectDomainRefusal(*ball, settings, "of memory with the other grids, and 0.03 GB are available");
  expectRefusal(*ball, settings, "of memory with the other grids, and 0.03 GB are available");
  settings.bytesBeside = 0;
  // Two small balls in a box of 30 GB are let through, as is a box of tiles.
  const auto at = [](double x) {
    return makeField("sphere",
                     {{"center", std::array<double, 3>{x, x, x}}, {"radius", 0.2}, {"falloff", 0.1}});
  };
  checkDomain(*makeField("union", {{"inputs", std::vector<FieldPtr>{at(-9), at(9)}}}), settings);
  checkDomain(*denseBox(20.0, 0.5), {0.01, 0.001, true, 1'000'000'000});
  // Bounds of noise leave all of the box open; its voxels decide.
  const FieldPtr noise = makeField("fbm", {{"cell_size", 0.3}});
  const auto inBox = [&](double lift) {
    const FieldPtr lifted = makeField(
        "add", {{"inputs", std::vector<FieldPtr>{noise, makeField("constant", {{"value", lift}})}}});
    return makeField("multiply", {{"inputs", std::vector<FieldPtr>{denseBox(4.0, 1.0), lifted}}});
  };
  settings.memoryBytes = 50'000'000;
  expectDomainRefusal(*inBox(0.5), settings, "of memory");
  checkDomain(*inBox(-0.75), settings);
}

TEST(Voxelize, RefusesDomainsBeforeFilling) {
  expectDomainRefusal(*makeField("fbm"), {0.1, 0.001, true}, "fills all of space");
  expectDomainRefusal(*makeField("sphere", {{"radius", 1e4}}), {0.01, 0.001, true}, "8e+18 voxels");
  expectDomainRefusal(*makeField("sphere", {{"center", std::array<double, 3>{1e9, 0, 0}}}),
                      {0.1, 0.001, true}, "beyond 2^30");
  // Just below the limit: 9.3e11 voxels, of which the ball fills half.
  expectDomainRefusal(*makeField("sphere", {{"falloff", 1.0}}), {0.000205, 0.001, true, 1'000'000'000'000},
                      "GB of memory");
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
