// Coarser levels against what they must keep (integrals, ramps, bounds), and cuts against covering a cloud
// once.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "volume/brick_layout.h"

namespace nephele {
namespace {

BrickVolume volumeOf(const glm::ivec3& size, const glm::ivec3& origin, double (*density)(glm::dvec3)) {
  std::vector<float> values;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        values.push_back(static_cast<float>(density(glm::dvec3(origin + glm::ivec3(x, y, z)))));
  return bricksFromDense(values, size, origin, glm::dmat4(1.0));
}

double waves(glm::dvec3 p) {
  const double wave = std::sin(0.21 * p.x + 0.1 * p.y) * std::cos(0.17 * p.z - 0.13 * p.y) - 0.2;
  return std::max(0.0, wave);
}

/// ∫ ρ over the whole index space, in voxels of the volume: every sample once.
double massOf(const BrickVolume& volume) {
  double mass = 0.0;
  for (const uint32_t slot : volume.index) {
    if (slot == 0) continue;
    const float* samples = volume.samples.data() + (slot - 1) * size_t{kBrickVolume};
    for (int z = 0; z < kBrickCells; ++z)
      for (int y = 0; y < kBrickCells; ++y)
        for (int x = 0; x < kBrickCells; ++x)
          mass += double{samples[(z * kBrickSamples + y) * kBrickSamples + x]};
  }
  return mass;
}

TEST(BrickLevels, KeepTheIntegralAndTheMaximum) {
  const BrickVolume volume = volumeOf({83, 61, 47}, {-19, 7, 1001}, waves);
  const BrickLevels levels(volume);
  for (int level = 1; level <= 5; ++level) {
    const double voxels = std::pow(8.0, level);
    EXPECT_NEAR(voxels * massOf(levels.at(level)), massOf(volume), 1e-5 * massOf(volume)) << level;
    EXPECT_LE(levels.at(level).maximum, volume.maximum * (1.0 + 1e-6));
    // Its samples lie where those of the finest do.
    const glm::dvec4 there = levels.at(level).worldFromIndex * glm::dvec4(3.0, 5.0, 7.0, 1.0);
    const double edge = std::ldexp(1.0, level);
    EXPECT_EQ(there, glm::dvec4(3.0 * edge, 5.0 * edge, 7.0 * edge, 1.0));
  }
}

TEST(BrickLevels, KeepRampsAwayFromTheirEnds) {
  const BrickVolume volume = volumeOf(glm::ivec3(64), glm::ivec3(-8), [](glm::dvec3 p) {
    return 0.25 + 0.01 * (p.x + 8.0) + 0.005 * (p.y + 8.0) + 0.003 * (p.z + 8.0);
  });
  const BrickLevels levels(volume);
  for (int level = 1; level <= 3; ++level) {
    const double edge = std::ldexp(1.0, level);
    for (const glm::dvec3& p : {glm::dvec3(20.3, 17.0, 25.5), {16.0, 24.0, 32.0}, {30.9, 21.1, 16.2}})
      EXPECT_NEAR(densityAt(levels.at(level), p / edge), densityAt(volume, p), 2e-6) << level;
  }
}

TEST(BrickLevels, EmptyStaysEmpty) {
  const BrickVolume none = bricksFromDense({0.0f}, glm::ivec3(1), glm::ivec3(0), glm::dmat4(1.0));
  EXPECT_TRUE(coarser(none).empty());
  EXPECT_TRUE(cutFor(BrickLevels(none), Resolution{{0, 0, -1e6}, 100.0, 1.0}).bricks.empty());
}

TEST(BrickCut, LevelsFollowTheProjectedSize) {
  const glm::dmat4 world(1.0);
  const glm::dvec3 low(0.0), high(10.0);
  const auto at = [&](double distance) {
    return levelFor({{5.0, 5.0, 10.0 + distance}, 100.0, 1.0}, world, low, high);
  };
  EXPECT_EQ(at(50.0), 0) << "two pixels a voxel";
  EXPECT_EQ(at(100.0), 0) << "one: the next level would take two";
  EXPECT_EQ(at(199.0), 0);
  EXPECT_EQ(at(200.0), 1) << "the next level takes one";
  EXPECT_EQ(at(1700.0), 4);
  EXPECT_EQ(at(1e9), BrickLevels::kMost);
  EXPECT_EQ(at(-5.0), 0) << "inside";
}

/// The brick's word and level at each brick of a frame must be those of the one cut brick around it.
void expectCover(const BrickLevels& levels, const Resolution& resolution) {
  const Cut cut = cutFor(levels, resolution);
  const BrickLayout layout = layOut(levels, {Texel::r32f, kLeastTextureLimit, resolution, 0, 0});
  ASSERT_EQ(layout.frame.brickCount, cut.frame.brickCount);
  std::vector<int> covered(layout.words.size(), 0);
  const glm::ivec3 n = cut.frame.brickCount;
  for (const CutBrick& brick : cut.bricks) {
    const int edge = 1 << brick.rise;
    const glm::ivec3 first = brick.brick * edge - cut.frame.brickMin;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(first[axis], 0);
      ASSERT_EQ(first[axis] % edge, 0) << "aligned to the corner, as the walk takes it";
    }
    for (int z = first.z; z < std::min(first.z + edge, n.z); ++z)
      for (int y = first.y; y < std::min(first.y + edge, n.y); ++y)
        for (int x = first.x; x < std::min(first.x + edge, n.x); ++x) {
          const size_t i = static_cast<size_t>((z * n.y + y) * n.x + x);
          ++covered[i];
          EXPECT_EQ(layout.words[i].y >> brick_word::kLevelShift & brick_word::kLevelMask,
                    static_cast<uint32_t>(brick.rise));
        }
  }
  double mass = 0.0;
  for (const CutBrick& brick : cut.bricks)
    for (int z = 0; z < kBrickCells; ++z)
      for (int y = 0; y < kBrickCells; ++y)
        for (int x = 0; x < kBrickCells; ++x)
          mass += std::pow(8.0, cut.frame.level + brick.rise) *
                  double{brick.samples[(z * kBrickSamples + y) * kBrickSamples + x]};
  EXPECT_NEAR(mass, massOf(levels.at(0)), 0.02 * massOf(levels.at(0))) << "seams lose next to nothing";
  for (size_t i = 0; i < covered.size(); ++i) {
    EXPECT_LE(covered[i], 1);
    EXPECT_EQ(covered[i] == 0, brick_word::isEmpty(layout.words[i]));
  }
}

TEST(BrickCut, CoversACloudOnce) {
  const BrickVolume volume = volumeOf({120, 50, 61}, {-19, 7, -30}, waves);
  const BrickLevels levels(volume);
  for (const double distance : {3.0, 30.0, 150.0, 1000.0}) {
    const Resolution resolution{{-19.0 - distance, 30.0, 0.0}, 40.0, 1.0};
    expectCover(levels, resolution);
  }
  const Cut near = cutFor(levels, Resolution{{-22.0, 30.0, 0.0}, 20.0, 1.0});
  EXPECT_EQ(near.frame.level, 0);
  EXPECT_GE(near.mostRise, 2);
  const Cut far = cutFor(levels, Resolution{{-2000.0, 30.0, 0.0}, 400.0, 1.0});
  EXPECT_EQ(far.frame.level, 2);
  EXPECT_EQ(far.mostRise, 0) << "all alike from afar";
}

TEST(BrickLayout, BeyondABudgetBricksComeFromCoarserLevels) {
  const BrickVolume volume = volumeOf({120, 50, 61}, {-19, 7, -30}, waves);
  const BrickLevels levels(volume);
  const Resolution resolution{{-100.0, 30.0, 0.0}, 1e4, 1.0};
  const BrickLayout whole = layOut(levels, {Texel::r16f, kLeastTextureLimit, resolution, 0, 0});
  EXPECT_EQ(whole.frame.level, 0);
  EXPECT_EQ(whole.pixels, 1.0);
  for (const uint64_t share : {2, 5, 20, 60}) {
    const uint64_t budget = whole.bytes() / share;
    const BrickLayout less = layOut(levels, {Texel::r16f, kLeastTextureLimit, resolution, budget, 0});
    EXPECT_LE(less.bytes(), budget);
    EXPECT_GT(less.pixels, 1.0) << "and it says so";
  }
  EXPECT_THROW(layOut(levels, {Texel::r16f, kLeastTextureLimit, resolution, 100, 0}), InputError);
  // Textures too small for the finest level.
  const BrickLayout small = layOut(levels, {Texel::r16f, 80, resolution, 0, 0});
  EXPECT_LE(std::max({small.size.x, small.size.y, small.size.z}), 80);
  EXPECT_GT(small.pixels, 1.0);
  EXPECT_THROW(layOut(volume, {Texel::r16f, 40, std::nullopt, 0, 0}), InputError);
}

}  // namespace
}  // namespace nephele
