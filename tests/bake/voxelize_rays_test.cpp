// Depths along rays without a grid: those of the grid that would be baked, at any rule of storage, and
// volumes of closed forms.
#include "bake/voxelize_rays.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

constexpr uint64_t kRays = 2000;

FieldPtr product(FieldPtr a, FieldPtr b) {
  return makeField("multiply", {{"inputs", Value{std::vector<FieldPtr>{std::move(a), std::move(b)}}}});
}

FieldPtr hardBox() { return makeField("box", {{"rounding", 0.0}, {"falloff", 0.0}}); }
FieldPtr noisySphere() { return product(makeField("sphere"), makeField("fbm", {{"cell_size", 0.5}})); }

VoxelizeSettings stepped(double voxelSize, double densityStep) {
  VoxelizeSettings settings{voxelSize, 0.001, true};
  settings.densityStep = densityStep;
  return settings;
}

/// Chords of a box that holds the test's fields and of which they fill a good part.
Chords chordsOf(uint64_t seed) { return randomChords(glm::dvec3(-1.0), glm::dvec3(1.0), kRays, seed); }

TEST(VoxelizeRays, SeeWhatTheGridHolds) {
  const Chords chords = chordsOf(1);
  for (const FieldPtr& field : {hardBox(), noisySphere(), makeField("warp", {{"input", noisySphere()}})})
    for (const VoxelizeSettings& settings :
         {VoxelizeSettings{0.05, 0.0, false}, VoxelizeSettings{0.013, 0.01, true},
          VoxelizeSettings{0.037, 0.2, false}, stepped(0.02, 0.0625)}) {
      const std::vector<double> grid = depthsAlong(bricksOf(voxelize(*field, settings)), chords.lines);
      const RayDepths rays = depthsAlong(*field, settings, chords.lines);
      // Lattices that begin elsewhere, and points, differ in rounding, which the cutoff and half's steps may
      // enlarge.
      const DepthDifference apart = differenceOf(grid, rays.depths);
      EXPECT_GT(apart.largestA, 0.03);
      EXPECT_LT(apart.relative(), 2e-4) << settings.voxelSize;
    }
}

TEST(VoxelizeRays, ConstantSpaceIsNotEvaluated) {
  const VoxelizeSettings settings{0.01, 0.0, false};
  const Chords chords = chordsOf(2);
  const uint64_t surface = depthsAlong(*hardBox(), settings, chords.lines).voxelsEvaluated;
  const FieldPtr noisy = product(hardBox(), makeField("fbm", {{"cell_size", 0.5}}));
  EXPECT_LT(surface, depthsAlong(*noisy, settings, chords.lines).voxelsEvaluated / 3);
}

TEST(VoxelizeRays, MeasureTheVolumeThatTheyFill) {
  // A cutoff of half keeps the inner half of the radius of 1.
  const VoxelizeSettings settings{0.02, 0.5, false};
  const Chords chords = chordsOf(3);
  const RayDepths rays = depthsAlong(*makeField("sphere"), settings, chords.lines);
  const double radius = 0.5, volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  // Half a voxel more all round; 2000 lines of which one in twelve meets it tell it to 7%.
  EXPECT_NEAR(chords.volumeOf(rays.lengthVaried), volume, 0.25 * volume);
}

TEST(VoxelizeRays, KnowTheLargestDensityThatTheyComeNear) {
  const Chords chords = chordsOf(6);
  for (const FieldPtr& field : {hardBox(), noisySphere()}) {
    const VoxelizeSettings settings = stepped(0.05, 0.0);
    const double maximum = depthsAlong(*field, settings, chords.lines).maximum;
    EXPECT_LE(maximum, voxelize(*field, settings).maximum);
    EXPECT_GT(maximum, 0.8 * voxelize(*field, settings).maximum);
  }
}

TEST(VoxelizeRays, AreTheSameOnAnyNumberOfThreads) {
  const VoxelizeSettings settings{0.02, 0.001, true};
  const FieldPtr field = noisySphere();
  const Chords chords = chordsOf(4);
  const std::vector<double> many = depthsAlong(*field, settings, chords.lines).depths;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many, depthsAlong(*field, settings, chords.lines).depths);
}

TEST(VoxelizeRays, RefuseWhatCannotBeStored) {
  const FieldPtr field = product(hardBox(), makeField("constant", {{"value", 1e5}}));
  const Chords chords = chordsOf(5);
  EXPECT_NO_THROW(depthsAlong(*field, {0.05, 0.0, false}, chords.lines));
  EXPECT_THROW(depthsAlong(*field, {0.05, 0.0, true}, chords.lines), VoxelizeError);
  EXPECT_THROW(depthsAlong(*makeField("constant"), {0.05, 0.0, false}, chords.lines), VoxelizeError);
}

}  // namespace
}  // namespace nephele::test
