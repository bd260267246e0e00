// What the light cache keeps, by the march compiled as C++: columns and openness against integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "preview/gpu/camera_rays.h"
#include "preview/twin/march_picture.h"

namespace nephele {
namespace {

TEST(LightCache, FarOctavesSeeThroughWhatHidesTheSun) {
  // A cube 144 optical depths deep with the sun straight behind it. The first order sees nothing of it; an
  // order with a hundredth of the extinction adds 1/(4π) ∫ σ e^(−σ s) e^(−0.01 σ (L − s)) ds.
  constexpr int kEdge = 48;
  constexpr double kSigma = 3.0, kLess = 0.01, kMiddle = 0.5 * (kEdge - 1);
  const BrickVolume bricks = bricksFromDense(std::vector<float>(size_t{kEdge} * kEdge * kEdge, 1.0f),
                                             glm::ivec3(kEdge), glm::ivec3(0), glm::dmat4(1.0));
  ViewedScene view;
  view.camera.target = glm::dvec3(kMiddle);
  view.camera.position = glm::dvec3(-1e3, kMiddle, kMiddle);
  view.camera.fov = 1e-4;
  view.medium = {{kSigma, kSigma, kSigma}, {0.0, 0.0, 0.0}, 0.0};
  view.scene.octaves = {1, kLess, 1.0, 0.0};
  view.scene.lights = {Sun{glm::dvec3(1.0, 0.0, 0.0), {1.0, 1.0, 1.0}}};
  view.scene.march.stepVoxels = 0.05;
  view.scene.march.adaptive = false;
  view.scene.march.cacheDepth = 1e3;  // the cache, however thick a voxel is
  const std::vector<TwinPixel> pixels =
      marchPicture(bricks, marchParameters(view, bricks, 1, 1, 0, false), 1, 1, glm::vec2(0.5f), 0);
  const double depth = kSigma * kEdge;  // the samples' 47 voxels and half a voxel's worth at either end
  const double expected =
      (std::exp(-kLess * depth) - std::exp(-depth)) / (1.0 - kLess) / (4.0 * std::numbers::pi);
  std::printf("octaves behind 144 optical depths: %.4f of the closed form\n",
              double{pixels[0].radiance.x} / expected);
  EXPECT_NEAR(double{pixels[0].radiance.x} / expected, 1.0, 0.02);
}

constexpr int kBlockEdge = 32;

BrickVolume evenBlock() {
  return bricksFromDense(std::vector<float>(size_t{kBlockEdge} * kBlockEdge * kBlockEdge, 1.0f),
                         glm::ivec3(kBlockEdge), glm::ivec3(0), glm::dmat4(1.0));
}

ViewedScene viewOfTheBlock() {
  ViewedScene view;
  view.camera.target = glm::dvec3(0.5 * kBlockEdge);
  view.camera.position = glm::dvec3(-3.0 * kBlockEdge, 0.5 * kBlockEdge, 0.5 * kBlockEdge);
  return view;
}

TEST(LightCache, OpennessKeepsItsSamplesWhereAPictureIsSmall) {
  const BrickVolume bricks = evenBlock();
  ViewedScene view = viewOfTheBlock();
  view.medium = {{0.5, 0.5, 0.5}, {0.0, 0.0, 0.0}, 0.0};
  view.scene.environment.constant = {1.0, 1.0, 1.0};
  view.scene.march.cacheDepth = 1e3;  // the cache, however thick a voxel is
  const auto samples = [&](int height, double d) {
    view.scene.octaves = {2, 0.5, 0.5, 0.5, d};
    return marchParameters(view, bricks, height, height, 0, false).cacheShape.y;
  };
  constexpr int kLarge = 1000, kSmall = 8;
  EXPECT_LT(samples(kSmall, 0.0), samples(kLarge, 0.0));
  EXPECT_EQ(samples(kSmall, 1.0), samples(kLarge, 1.0));
}

TEST(LightCache, ThinMediaTakeNoNearStepsAndSamplesFartherApartBeneathABrick) {
  BrickVolume bricks = evenBlock();
  ViewedScene view = viewOfTheBlock();
  view.scene.lights = {Sun{glm::dvec3(1.0, 0.0, 0.0), {1.0, 1.0, 1.0}}};
  struct Case {
    double depth, bulge;  // of a voxel; the largest density over the mean
    bool thin;
    int samples;  // along a block of 16 voxels
  };
  // Thin is a cell of 2 voxels of at most 0.06, of the densest 0.25: there samples lie so far apart, or a
  // brick.
  const Case cases[] = {{0.005, 1.0, true, 3}, {0.025, 1.0, true, 3},   {0.025, 2.0, true, 4},
                        {0.025, 4.0, true, 7}, {0.025, 10.0, false, 9}, {0.04, 1.0, false, 9}};
  constexpr int kHeight = 1000;
  const double mean = bricks.meanActive;
  for (const Case& on : cases) {
    SCOPED_TRACE(std::to_string(on.depth) + " by " + std::to_string(on.bulge));
    bricks.maximum = on.bulge * mean;
    view.medium = {{on.depth, on.depth, on.depth}, {0.0, 0.0, 0.0}, 0.0};
    const auto p = marchParameters(view, bricks, kHeight, kHeight, 0, false);
    EXPECT_EQ(p.cache.w, on.thin ? 0.0f : static_cast<float>(view.scene.march.cacheNearSteps));
    EXPECT_EQ(p.cacheShape.x, on.samples);
  }
}

TEST(LightCache, OrdersLoseWhatAnOpenPlaceLetsOut) {
  // A ball 6 optical depths across, by its middle: the order beyond the first, light of which nothing is
  // hidden (a = 0), adds 1/(4π) ∫ σ e^(−σ s) (1 − d E(r)) ds, r the distance from the centre and E the mean
  // over directions of e^(−σ way out).
  constexpr int kEdge = 64;
  constexpr double kRadius = 30.0, kSigma = 0.1, kOpen = 0.9, kMiddle = 0.5 * (kEdge - 1);
  std::vector<float> density;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x)
        density.push_back(glm::length(glm::dvec3(x, y, z) - kMiddle) < kRadius ? 1.0f : 0.0f);
  const BrickVolume bricks = bricksFromDense(density, glm::ivec3(kEdge), glm::ivec3(0), glm::dmat4(1.0));
  ViewedScene view;
  view.camera.target = glm::dvec3(kMiddle);
  view.camera.position = glm::dvec3(-1e3, kMiddle, kMiddle);
  view.camera.fov = 1e-4;
  view.medium = {{kSigma, kSigma, kSigma}, {0.0, 0.0, 0.0}, 0.0};
  view.scene.lights = {Sun{glm::dvec3(1.0, 0.0, 0.0), {1.0, 1.0, 1.0}}};
  view.scene.march.stepVoxels = 0.05;
  view.scene.march.adaptive = false;
  const auto seen = [&](int count, double d, bool cached) {
    view.scene.octaves = {count, 0.0, 1.0, 0.0, d};
    view.scene.march.lightCache = cached;
    const shared::MarchParameters p = marchParameters(view, bricks, 1, 1, 0, false);
    return double{marchPicture(bricks, p, 1, 1, glm::vec2(0.5f), 0)[0].radiance.x};
  };
  double expected = 0.0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double s = 2.0 * kRadius * (i + 0.5) / kSteps, r = std::abs(kRadius - s);
    double open = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double mu = -1.0 + 2.0 * (k + 0.5) / kSteps;
      open += std::exp(-kSigma * (std::sqrt(kRadius * kRadius - r * r * (1.0 - mu * mu)) - r * mu)) / kSteps;
    }
    expected += kSigma * std::exp(-kSigma * s) * (1.0 - kOpen * open) * 2.0 * kRadius / kSteps;
  }
  expected /= 4.0 * std::numbers::pi;
  for (const bool cached : {false, true}) {  // marched light knows openness from the cache too
    const double added = seen(1, kOpen, cached) - seen(0, kOpen, cached);
    std::printf("light scattered again in a ball: %.4f of the integral\n", added / expected);
    EXPECT_NEAR(added / expected, 1.0, 0.02);
    EXPECT_LT(added, 0.8 * (seen(1, 0.0, cached) - seen(0, 0.0, cached)));
  }
}

}  // namespace
}  // namespace nephele
