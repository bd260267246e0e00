// The stage by the path tracer against closed forms: Lambert's floor below a homogeneous slab, mirrors
// through it, shadows of things.
#include "preview/truth/stage.h"

#include "base/error.h"
#include "tests/preview/truth_bench.h"

namespace nephele {
namespace {

using namespace testing_truth;
using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr double kIrradiance = 3.0, kDark = 0.1, kGrey = 0.18, kMirror = 0.9;
constexpr double kDepth = 1.2;  // optical, straight through the slab

/// A slab about z = 0: 8 voxels of 0.1 thick, wide enough for slanting rays, density 1. It fades over a voxel
/// at each face: columns are exact.
BrickVolume slab() {
  glm::dmat4 place(0.1);
  place[0][0] = place[1][1] = 0.5;
  place[3] = glm::dvec4(-10.0, -10.0, -0.35, 1.0);
  return volumeOf({41, 41, 8}, {0, 0, 0}, place, [](const dvec3&) { return 1.0; });
}

/// Straight down through the slab at (1, 1), onto the floor's dark square.
ViewedScene staged(double albedo) {
  const double sigma = kDepth / 0.8;
  ViewedScene view =
      viewFrom({1.0, 1.0, 8.0}, {1.0, 1.0, 0.0}, 0.02, mediumOf(sigma * albedo, sigma * (1.0 - albedo), 0.0));
  Stage& stage = view.scene.stage;
  stage.on = true;
  stage.height = -2.0;
  stage.checker = 5.0;
  stage.chrome.on = stage.grey.on = false;
  return view;
}

double radianceOf(const ViewedScene& view, unsigned samples = 2048) {
  return meanOf(renderTruth(slab(), view, requestOf(8, samples, 0)).planes[0]);
}

TEST(TruthStage, AFloorShowsThroughASlabThatShadesIt) {
  // surface · T + scattered, all of the first order.
  const dvec3 toLight = glm::normalize(dvec3(0.3, 0.2, 1.0));
  const double mu = toLight.z, both = std::exp(-kDepth * (1.0 + 1.0 / mu));
  for (const double albedo : {0.0, 0.7}) {
    ViewedScene view = staged(albedo);
    view.scene.lights = {sunFrom(toLight, kIrradiance)};
    const double floor = kDark / kPi * kIrradiance * mu * both;
    const double scattered = albedo * kIrradiance / (4.0 * kPi) * mu / (1.0 + mu) * (1.0 - both);
    EXPECT_NEAR(radianceOf(view) / (floor + scattered), 1.0, 5e-3) << albedo;
  }
}

TEST(TruthStage, TheSkyLightsAFloorThroughTheSlab) {
  // Beside the slab nothing is between: a floor far below it sees the whole sky.
  ViewedScene view = staged(0.0);
  view.scene.stage.height = -2000.0;
  view.scene.stage.checker = 1e5;
  view.camera.fov = 1e-5;  // the floor's dark square alone
  view.scene.environment.constant = {2.0, 2.0, 2.0};
  EXPECT_NEAR(radianceOf(view) / (kDark * 2.0 * std::exp(-kDepth)), 1.0, 5e-3);
}

TEST(TruthStage, AMirrorShowsTheSkyThroughTheSlabTwice) {
  ViewedScene view = staged(0.0);
  view.scene.stage.cube = {true, dvec3(1.0, 1.0, -1.5), 0.8};
  view.scene.environment.constant = {2.0, 2.0, 2.0};
  EXPECT_NEAR(radianceOf(view) / (kMirror * 2.0 * std::exp(-2.0 * kDepth)), 1.0, 5e-3);
  view.scene.stage.cube.on = false;
  view.scene.stage.floor = false;
  view.scene.stage.chrome = {true, dvec3(1.0, 1.0, -1.5), 0.5};
  view.camera.fov = 1e-4;  // the ball's top reflects straight up
  EXPECT_NEAR(radianceOf(view) / (kMirror * 2.0 * std::exp(-2.0 * kDepth)), 1.0, 5e-3);
}

TEST(TruthStage, ThingsShadowFloorAndMedium) {
  ViewedScene view = staged(0.7);
  view.scene.lights = {sunFrom({0, 0, 1}, kIrradiance)};
  view.scene.stage.grey = {true, dvec3(1.0, 1.0, 20.0), 2.0};  // behind the camera, before the sun
  EXPECT_EQ(radianceOf(view, 4), 0.0);
  view.scene.stage.grey = {true, dvec3(1.0, 1.0, 4.0), 0.5};  // before the medium
  EXPECT_NEAR(radianceOf(view, 64) / (kGrey / kPi * kIrradiance), 1.0, 2e-2);
  const Picture picture = renderTruth(slab(), view, requestOf(8, 16, 0));
  for (const float alpha : plane(picture, "A")) EXPECT_EQ(alpha, 1.0f);
}

TEST(TruthStage, IsOfTheFirstOrderAlone) {
  const auto method = makeReferenceMethod({});
  const BrickVolume bricks = slab();
  method->setVolume(bricks);
  PictureCost cost;
  EXPECT_THROW(method->render(staged(0.5), requestOf(8, 4), cost), InputError);
}

}  // namespace
}  // namespace nephele
