// What the light cache keeps, by the march compiled as C++: columns against a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

}  // namespace
}  // namespace nephele
