// Stretched and eroded particles: mass, what noise leaves of them, and reading them along rays alone.
#include "bake/splat_shaped.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <glm/vector_relational.hpp>

#include "bake/splat.h"
#include "bake/splat_kernels.h"
#include "tests/bake/every_target.h"
#include "tests/bake/field_samples.h"
#include "tests/bake/particle_cloud.h"
#include "volume/chord_voxels.h"

namespace nephele::test {
namespace {

TEST(SplatShaped, StretchesAlongVelocityAndKeepsMass) {
  for (const SplatKernel kernel : kKernels) {
    Cloud cloud;
    cloud.add({0.5f, 0.5f, 0.5f}, 2.0f, 3.0f, {40.0f, 0.0f, 0.0f});
    cloud.add({0.5f, 30.5f, 0.5f}, 0.3f, 3.0f, {0.0f, 20.0f, 20.0f});
    SplatSettings settings = plain(kernel);
    settings.shutterSeconds = 0.5;  // 20 voxels
    const Splatted splatted = splat(cloud.particles(), settings);
    EXPECT_NEAR(splatted.ledger.stored / 6.0, 1.0, 1e-5);
    const BrickVolume bricks = stored(splatted);
    // Even along the line, then nothing.
    EXPECT_NEAR(densityAt(bricks, {-5, 0, 0}), densityAt(bricks, {5, 0, 0}), 1e-6);
    EXPECT_GT(densityAt(bricks, {9, 0, 0}), 0.0);
    EXPECT_EQ(densityAt(bricks, {13, 0, 0}), 0.0);
    EXPECT_EQ(densityAt(bricks, {0, 4, 0}), 0.0);
  }
}

TEST(SplatShaped, ErosionEatsIntoParticlesAndKeepsMass) {
  Cloud cloud = randomCloud(40, 20.0f, 3.0f, 9.0f);
  SplatSettings settings = plain();
  const Splatted whole = splat(cloud.particles(), settings);
  settings.erosion = makeField("fbm", {{"cell_size", 0.5}});
  settings.erosionAmount = 1.5;
  const Splatted eaten = splat(cloud.particles(), settings);
  EXPECT_NEAR(eaten.ledger.stored / cloud.total(), 1.0, 1e-5);
  EXPECT_LT(double(eaten.voxelsActive), 0.95 * double(whole.voxelsActive));
  settings.erosion = makeField("constant", {{"value", 2.0}});  // leaves nothing
  const Splatted nothingLeft = splat(cloud.particles(), settings);
  EXPECT_NEAR(nothingLeft.ledger.stored / cloud.total(), 1.0, 1e-5);
  EXPECT_LE(nothingLeft.voxelsActive, 40u * 8u);
}

/// Counts the points that it is asked for.
class CountingField : public Field {
 public:
  explicit CountingField(FieldPtr inner) : inner_(std::move(inner)) {}
  void evaluate(const Points& points, float* values) const override {
    asked += points.count;
    inner_->evaluate(points, values);
  }
  Interval bounds(const Box& box) const override { return inner_->bounds(box); }
  Box support() const override { return inner_->support(); }
  mutable std::atomic<size_t> asked{0};

 private:
  FieldPtr inner_;
};

TEST(SplatShaped, ErosionIsEvaluatedOnceAndWeightsAreTheSameWhetherKeptOrNot) {
  const Cloud cloud = randomCloud(20, 20.0f, 3.0f, 9.0f);
  const SplatParticles particles = cloud.particles();
  SplatSettings settings = plain();
  const auto field = std::make_shared<CountingField>(makeField("fbm", {{"cell_size", 0.5}}));
  settings.erosion = field;
  settings.erosionAmount = 1.5;
  const SplatPlaces places(particles, settings);
  SplatShaping kept(particles, settings), forgotten(particles, settings, 0);
  kept.makeRoom();
  forgotten.makeRoom();
  size_t same = 0;
  for (size_t n = 0; n < particles.size(); ++n) {
    const SplatFrame f = places.frameOf(n);
    EXPECT_EQ(kept.sum(n, f), forgotten.sum(n, f));
    for (int x = -32; x < 32; x += kLeafEdge)
      for (int y = -32; y < 32; y += kLeafEdge)
        for (int z = -32; z < 32; z += kLeafEdge) {
          const glm::ivec3 origin(x, y, z), low = f.low & ~(kLeafEdge - 1);
          if (glm::any(glm::lessThan(origin, low)) || glm::any(glm::greaterThan(origin, f.high))) continue;
          float a[kLeafVoxels] = {}, b[kLeafVoxels] = {};
          EXPECT_EQ(kept.weights(n, f, origin, a), forgotten.weights(n, f, origin, b));
          EXPECT_EQ(std::memcmp(a, b, sizeof a), 0);
          ++same;
        }
  }
  EXPECT_GT(same, 8 * particles.size());
  field->asked = 0;
  for (size_t n = 0; n < particles.size(); ++n) forgotten.sum(n, places.frameOf(n));
  const size_t once = field->asked.exchange(0);
  splat(particles, settings);
  EXPECT_EQ(field->asked, once);
}

/// Eaten by noise; with a shutter they are stretched as well.
SplatSettings eroded(FieldPtr field, SplatKernel kernel = SplatKernel::wendland) {
  SplatSettings settings = plain(kernel);
  settings.erosion = std::move(field);
  settings.erosionAmount = 1.5;
  return settings;
}

FieldPtr noise() { return makeField("fbm", {{"cell_size", 0.5}}); }

constexpr double kBoxEdge = 60.0;
Chords raysThroughBox(uint64_t count) {
  return randomChords(glm::dvec3(-kBoxEdge), glm::dvec3(kBoxEdge), count, 3);
}

std::vector<double> depthsOf(const Splatted& splatted, const Chords& chords) {
  return depthsAlong(bricksOf(splatted), chords.lines);
}

/// Depths of a splat that rays alone look at.
std::vector<double> measuredDepths(const Cloud& cloud, SplatSettings settings, const Chords& chords,
                                   std::vector<double> sums = {}) {
  const ChordVoxels read(chords.lines, settings.voxelSize, glm::dvec3(-kBoxEdge), glm::dvec3(kBoxEdge));
  const SplatMeasure measure{read, sums};
  settings.measure = &measure;
  return depthsOf(splat(cloud.particles(), settings), chords);
}

TEST(SplatShaped, RaysSeeInTheirVoxelsWhatTheySeeInAll) {
  // So small that all of their voxels make the sums; points and round particles beside them.
  const Cloud cloud = randomCloud(300, 20.0f, 0.3f, 5.5f);
  const Chords chords = raysThroughBox(400);
  for (const SplatKernel kernel : kKernels)
    for (const double shutter : {0.0, 2.0})
      for (const FieldPtr& field : {FieldPtr(), noise()}) {
        SplatSettings settings = plain(kernel);
        if (field) settings = eroded(field, kernel);
        settings.shutterSeconds = shutter;
        settings.half = true;
        settings.cutoff = 0.002;
        settings.densityStep = 1.0 / 256.0;
        const std::vector<double> all = depthsOf(splat(cloud.particles(), settings), chords),
                                  some = measuredDepths(cloud, settings, chords);
        const DepthDifference d = differenceOf(all, some);
        // Sums of floats in another order may round a voxel to its other neighbour.
        EXPECT_LT(d.relative(), 2e-4) << int(kernel) << ' ' << shutter << ' ' << bool(field);
        EXPECT_GT(d.largestA, 0.0);
      }
}

TEST(SplatShaped, RaysAskForFewVoxelsAndKnowTheMassOfWideParticles) {
  const Cloud cloud = randomCloud(20, 8.0f, 40.0f, 48.0f);
  const Chords chords = raysThroughBox(40);
  const auto field = std::make_shared<CountingField>(noise());
  const SplatSettings settings = eroded(field);
  const std::vector<double> all = depthsOf(splat(cloud.particles(), settings), chords);
  const size_t asked = field->asked.exchange(0);
  const std::vector<double> some = measuredDepths(cloud, settings, chords);
  EXPECT_LT(field->asked, asked / 2);
  EXPECT_LT(differenceOf(all, some).relative(), 0.25 * kMassTolerance);
  EXPECT_NE(all, some);
}

TEST(SplatShaped, SumsThatAreKnownAreNotFoundAgain) {
  const Cloud cloud = randomCloud(20, 12.0f, 3.0f, 18.0f);
  const Chords chords = raysThroughBox(40);
  const auto field = std::make_shared<CountingField>(noise());
  SplatSettings settings = eroded(field);
  const ChordVoxels read(chords.lines, settings.voxelSize, glm::dvec3(-kBoxEdge), glm::dvec3(kBoxEdge));
  std::vector<double> sums;
  const SplatMeasure measure{read, sums};
  settings.measure = &measure;
  const std::string found = contentHashOf(splat(cloud.particles(), settings));
  const size_t first = field->asked.exchange(0);
  ASSERT_EQ(sums.size(), cloud.x.size());
  EXPECT_EQ(contentHashOf(splat(cloud.particles(), settings)), found);
  EXPECT_LT(field->asked, first / 2);
  for (double& sum : sums) sum *= 2.0;
  EXPECT_NE(contentHashOf(splat(cloud.particles(), settings)), found);
}

TEST(SplatShaped, SumsOfFewerVoxelsAreNearTheSumsOfAll) {
  const Cloud cloud = randomCloud(40, 20.0f, 3.0f, 30.0f);
  const SplatParticles particles = cloud.particles();
  const SplatSettings settings = eroded(noise());
  const SplatPlaces places(particles, settings);
  SplatShaping shaping(particles, settings);
  double squares = 0.0;
  for (size_t n = 0; n < particles.size(); ++n) {
    const double all = shaping.sum(n, places.frameOf(n)), fewer = shaping.sumOfFewer(n, places);
    EXPECT_NEAR(fewer / all, 1.0, 1.5 * kMassTolerance) << particles.radius[n];
    // Too small for a coarser lattice.
    if (particles.radius[n] < 6.0f) {
      EXPECT_EQ(fewer, all);
    }
    squares += (fewer / all - 1.0) * (fewer / all - 1.0);
  }
  EXPECT_LT(std::sqrt(squares / double(particles.size())), 0.5 * kMassTolerance);
  EXPECT_GT(squares, 0.0);
}

TEST(SplatShaped, WhatRaysSeeIsTheSameOnEveryTarget) {
  const Cloud cloud = randomCloud(200, 20.0f, 0.3f, 12.0f);
  const Chords chords = raysThroughBox(100);
  expectEqualBitsOnEveryTarget([&] {
    std::vector<float> values;
    for (const SplatKernel kernel : kKernels)
      for (const double depth : measuredDepths(cloud, eroded(noise(), kernel), chords))
        values.push_back(float(depth));
    return values;
  });
}

}  // namespace
}  // namespace nephele::test
