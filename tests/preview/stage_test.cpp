// The look-dev stage by the march compiled as C++: closed forms of a surface's light, of what the medium
// takes from it, of mirrors, shadows and the floor.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/gpu/camera_rays.h"
#include "preview/twin/march_picture.h"

namespace nephele {
namespace {

constexpr int kEdge = 16;
constexpr double kMiddle = 0.5 * (kEdge - 1);

/// A cube of density 1 from −½ to 15½ voxels, one world unit each; the camera 100 units off along −x, looking
/// at a ball beyond the cube. Nothing else stands on the stage.
struct Bench {
  BrickVolume bricks = bricksFromDense(std::vector<float>(size_t{kEdge} * kEdge * kEdge, 1.0f),
                                       glm::ivec3(kEdge), glm::ivec3(0), glm::dmat4(1.0));
  ViewedScene view;

  Bench() {
    view.camera.position = glm::dvec3(-100.0, kMiddle, kMiddle);
    view.camera.target = glm::dvec3(kMiddle);
    view.camera.fov = 1e-3;
    view.medium = {{0.0, 0.0, 0.0}, {0.02, 0.02, 0.02}, 0.0};
    view.scene.lights = {Sun{glm::dvec3(-1.0, 0.0, 0.0), {2.0, 3.0, 4.0}}};
    view.scene.march = {0.1, 0.1, 1.0, false, false};
    Stage& stage = view.scene.stage;
    stage.on = true;
    stage.floor = stage.chrome.on = stage.cube.on = false;
    stage.grey.center = glm::dvec3(40.0, kMiddle, kMiddle);
    stage.grey.size = 10.0;
    stage.highlights = false;
  }
  TwinPixel pixel() const {
    return marchPicture(bricks, marchParameters(view, bricks, 1, 1, 0, false), 1, 1, glm::vec2(0.5f), 0)[0];
  }
};

constexpr double kGrey = 0.18, kMirror = 0.9, kTau = 0.02 * kEdge;

TEST(Stage, SurfaceIsSeenAndLitThroughTheMedium) {
  // Lambert: E/π · albedo; the sun stands behind the camera, so that its light crosses the medium as well.
  const TwinPixel pixel = Bench().pixel();
  const double expected = kGrey * 2.0 / std::numbers::pi * std::exp(-2.0 * kTau);
  EXPECT_NEAR(double{pixel.radiance.x} / expected, 1.0, 2e-3);
  EXPECT_NEAR(double{pixel.radiance.z / pixel.radiance.x}, 2.0, 1e-5);
  EXPECT_EQ(pixel.transmittance.x, 0.0f) << "nothing is seen behind a surface";
  // Depth: the medium's share at its mean distance, the rest at the ball's face, 130 from the camera.
  EXPECT_NEAR(double{pixel.depthWeight}, 1.0, 1e-5);
  EXPECT_GT(pixel.depth, 120.0f);
  EXPECT_LT(pixel.depth, 130.0f);
}

TEST(Stage, AThingInTheMediumHidesWhatIsBehind) {
  // The ball's face at x = 7.5, in the middle of the cube: half the depth on the way in and out.
  Bench bench;
  bench.view.scene.stage.grey.center = glm::dvec3(17.5, kMiddle, kMiddle);
  const double expected = kGrey * 2.0 / std::numbers::pi * std::exp(-kTau);
  EXPECT_NEAR(double{bench.pixel().radiance.x} / expected, 1.0, 2e-3);
}

TEST(Stage, HighlightsAddToLambert) {
  Bench bench;
  const double without = double{bench.pixel().radiance.x};
  bench.view.scene.stage.highlights = true;
  // K_s of the grey ball is 0.25, and half-way vector and normal are one.
  EXPECT_NEAR(double{bench.pixel().radiance.x} / without, (kGrey + 0.25) / kGrey, 2e-3);
}

TEST(Stage, ChromeMirrorsTheEnvironmentAndTheCloud) {
  Bench bench;
  Scene& scene = bench.view.scene;
  scene.lights.clear();
  scene.environment.constant = {1.0, 2.0, 3.0};
  std::swap(scene.stage.grey, scene.stage.chrome);
  scene.stage.grey.on = false;
  scene.stage.chrome.on = true;
  // Twice through the absorbing medium: to the ball, and in it the mirrored cloud.
  EXPECT_NEAR(double{bench.pixel().radiance.y} / (2.0 * kMirror * std::exp(-2.0 * kTau)), 1.0, 2e-3);
}

TEST(Stage, ThingsShadeEachOther) {
  // A sun beside the view, and a chrome ball between it and the grey one's lit side.
  Bench bench;
  Stage& stage = bench.view.scene.stage;
  const double s = std::sqrt(0.5);
  bench.view.scene.lights = {Sun{glm::dvec3(-s, s, 0.0), {2.0, 2.0, 2.0}}};
  const glm::dvec3 face(30.0, kMiddle, kMiddle);
  const double open = double{bench.pixel().radiance.x};
  EXPECT_NEAR(open / (kGrey * 2.0 * s / std::numbers::pi * std::exp(-kTau)), 1.0, 2e-2);
  stage.chrome = {true, face + 20.0 * glm::dvec3(-s, s, 0.0), 5.0};
  EXPECT_EQ(bench.pixel().radiance.x, 0.0f);
  // Off the axis by 8 at 20: distance 3 past the ball's side. k · d/t is least near there.
  stage.chrome.center = face + 20.0 * glm::dvec3(-s, s, 0.0) + glm::dvec3(0.0, 0.0, 8.0);
  stage.penumbra = 2.0;
  const double half = double{bench.pixel().radiance.x} / open;
  double least = 1.0;
  for (double t = 0.05; t < 60.0; t += 0.01)
    least = std::min(least, 2.0 * (std::hypot(t - 20.0, 8.0) - 5.0) / t);
  EXPECT_NEAR(half, least, 2e-2) << "clamp(min k d/t, 0, 1) [Quilez]";
  stage.penumbra = 0.0;
  EXPECT_NEAR(double{bench.pixel().radiance.x} / open, 1.0, 1e-6) << "hard shadows have no penumbra";
}

TEST(Stage, TheFloorIsCheckered) {
  // Seen from above without medium before it: two squares, albedo 0.5 and 0.1.
  Bench bench;
  Stage& stage = bench.view.scene.stage;
  stage.floor = true;
  stage.grey.on = false;
  stage.height = -5.0;
  stage.checker = 4.0;
  bench.view.scene.lights = {Sun{glm::dvec3(0.0, 0.0, 1.0), {1.0, 1.0, 1.0}}};
  double seen[2] = {};
  for (int i = 0; i < 2; ++i) {
    // The squares' corner lies below the middle of the cells, at 7.5.
    bench.view.camera.target = glm::dvec3(kMiddle + 30.0 + 4.0 * i, kMiddle + 2.0, -5.0);
    bench.view.camera.position = bench.view.camera.target + glm::dvec3(0.0, 0.0, 20.0);
    bench.view.camera.up = glm::dvec3(0.0, 1.0, 0.0);
    seen[i] = double{bench.pixel().radiance.x} * std::numbers::pi;
  }
  EXPECT_NEAR(std::max(seen[0], seen[1]), 0.5, 1e-4);
  EXPECT_NEAR(std::min(seen[0], seen[1]), 0.1, 1e-4);
}

TEST(Stage, OffChangesNothing) {
  Bench bench;
  bench.view.scene.stage.on = false;
  EXPECT_NEAR(double{bench.pixel().transmittance.x}, std::exp(-kTau), 1e-4);
  EXPECT_EQ(bench.pixel().radiance.x, 0.0f);
}

}  // namespace
}  // namespace nephele
