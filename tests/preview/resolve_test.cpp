// Framing, up axis and the medium's three sources.
#include "preview/resolve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/error.h"

namespace nephele {
namespace {

using glm::dvec3;

BrickVolume smallVolume() {
  glm::dmat4 worldFromIndex(0.25);
  worldFromIndex[3] = glm::dvec4(10.0, -20.0, 30.0, 1.0);
  return bricksFromDense(std::vector<float>(6 * 8 * 10, 2.0f), {6, 8, 10}, {-3, 4, 5}, worldFromIndex);
}

/// The largest of |x| and |y| of the box's corners in the picture, where 1 is its border.
double reachInPicture(const BrickVolume& bricks, const Camera& camera, double aspect) {
  const dvec3 forward = glm::normalize(camera.target - camera.position);
  const dvec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const double half = std::tan(0.5 * camera.fov);
  double reach = 0.0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 index((i & 1) ? bricks.activeMax.x : bricks.activeMin.x - 1,
                      (i & 2) ? bricks.activeMax.y : bricks.activeMin.y - 1,
                      (i & 4) ? bricks.activeMax.z : bricks.activeMin.z - 1);
    const dvec3 offset = dvec3(bricks.worldFromIndex * glm::dvec4(index, 1.0)) - camera.position;
    const double along = glm::dot(offset, forward);
    EXPECT_GT(along, 0.0);
    reach = std::max({reach, std::abs(glm::dot(offset, up)) / along / half,
                      std::abs(glm::dot(offset, right)) / along / half / aspect});
  }
  return reach;
}

TEST(Framing, TheBoxFillsThePictureWithALittleMargin) {
  const BrickVolume bricks = smallVolume();
  for (double aspect : {0.3, 1.0, 16.0 / 9.0})
    for (const dvec3& up : {dvec3(0, 0, 1), dvec3(0, 1, 0)}) {
      const double reach = reachInPicture(bricks, frameCamera(bricks, up, 0.6, aspect), aspect);
      EXPECT_LT(reach, 1.0);
      EXPECT_GT(reach, 0.9);
    }
}

TEST(Framing, AStageIsSeenFromAboveItsFloor) {
  const BrickVolume bricks = smallVolume();
  Stage stage;
  for (const dvec3& up : {dvec3(0, 0, 1), dvec3(0, 1, 0)}) {
    const Camera plain = frameCamera(bricks, up, 0.6, 1.5, stage);
    EXPECT_FALSE(seesFloorFromBelow(plain, stage, up, bricks)) << "there is none";
    stage.on = true;
    EXPECT_TRUE(seesFloorFromBelow(plain, stage, up, bricks)) << "clouds are framed from below";
    const Camera raised = frameCamera(bricks, up, 0.6, 1.5, stage);
    EXPECT_FALSE(seesFloorFromBelow(raised, stage, up, bricks));
    EXPECT_LT(reachInPicture(bricks, raised, 1.5), 1.0);
    stage.floor = false;
    EXPECT_FALSE(seesFloorFromBelow(plain, stage, up, bricks));
    stage = Stage{};
  }
}

TEST(UpAxis, MetadataThenHoudiniThenZ) {
  BrickVolume bricks = smallVolume();
  EXPECT_EQ(upOf(bricks), dvec3(0, 0, 1));
  bricks.metadata["creator"] = "Houdini/SOP_OpenVDB";
  EXPECT_EQ(upOf(bricks), dvec3(0, 1, 0));
  bricks.metadata["up_axis"] = "z";
  EXPECT_EQ(upOf(bricks), dvec3(0, 0, 1));
  bricks.upAxis = 'y';
  EXPECT_EQ(upOf(bricks), dvec3(0, 1, 0));
}

TEST(MediumChoice, SceneThenFileThenExposure) {
  BrickVolume bricks = smallVolume();
  Scene scene;
  const ChosenMedium exposed = chooseMedium(scene, bricks);
  EXPECT_EQ(exposed.source, MediumSource::exposure);
  // 480 voxels of side 0.25 at density 2: σ · 2 · 0.25 · ∛480 = 8.
  EXPECT_NEAR(exposed.medium.sigmaS[1] * 2.0 * 0.25 * std::cbrt(480.0), 8.0, 1e-9);
  EXPECT_EQ(exposed.medium.sigmaA[1], 0.0);
  bricks.metadata["sigma_s"] = "[1, 2, 3]";
  bricks.metadata["sigma_a"] = "0.5";
  bricks.metadata["g"] = "-0.25";
  const ChosenMedium ofFile = chooseMedium(scene, bricks);
  EXPECT_EQ(ofFile.source, MediumSource::file);
  EXPECT_EQ(ofFile.medium.sigmaS, (Rgb{1.0, 2.0, 3.0}));
  EXPECT_EQ(ofFile.medium.sigmaA, (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(ofFile.medium.g, -0.25);
  scene.medium = Medium{};
  EXPECT_EQ(chooseMedium(scene, bricks).source, MediumSource::scene);
}

/// A scene that leaves the octaves open, lit from a height in degrees, and a file with factors for three
/// heights.
Scene litAt(double elevation) {
  Scene scene;
  scene.look = Look::report;
  Sun sun;
  sun.toLight = {std::cos(glm::radians(elevation)), 0.0, std::sin(glm::radians(elevation))};
  scene.lights = {sun};
  return scene;
}

BrickVolume fittedVolume() {
  BrickVolume bricks = smallVolume();
  bricks.metadata = {{"up_axis", "z"},
                     {"sigma_s", "1"},
                     {"octaves_a", "[0.25, 0.5, 1]"},
                     {"octaves_b", "[0.5, 0.5, 0.5]"},
                     {"octaves_c", "[1, 1, 1]"},
                     {"octaves_count", "6"}};
  return bricks;
}

TEST(FittedFactors, FollowTheSunAndLeaveTheCount) {
  const BrickVolume bricks = fittedVolume();
  std::string sentence;
  ViewedScene view = resolveScene(litAt(5.0), bricks, 1.0, sentence);
  EXPECT_EQ(view.scene.octaves.a, 0.25);
  EXPECT_EQ(view.scene.octaves.count, 6) << "the file's, where the scene leaves it open";
  view.scene.octaves.count = 3;
  view.scene.lights = litAt(60.0).lights;
  followSun(view.scene, view.medium, bricks, view.up);
  EXPECT_NEAR(view.scene.octaves.a, 1.0, 1e-12);
  EXPECT_EQ(view.scene.octaves.count, 3);
  view.scene.octaves.factorsGiven = true;
  view.scene.lights = litAt(5.0).lights;
  followSun(view.scene, view.medium, bricks, view.up);
  EXPECT_NEAR(view.scene.octaves.a, 1.0, 1e-12) << "factors that are given do not follow";
  view.scene.octaves = {};
  view.scene.octaves.count = 0;
  followSun(view.scene, view.medium, bricks, view.up);
  EXPECT_EQ(view.scene.octaves.a, Octaves{}.a) << "there are none to follow";
}

TEST(FittedFactors, AreToldWithTheSunsHeight) {
  const BrickVolume bricks = fittedVolume();
  const auto told = [&](const Scene& scene) {
    std::string sentence;
    resolveScene(scene, bricks, 1.0, sentence);
    return sentence;
  };
  EXPECT_NE(told(litAt(5.0)).find("as fitted to the file for a sun at 5 degrees: a 0.25, b 0.5, c 1"),
            std::string::npos)
      << told(litAt(5.0));
  EXPECT_NE(told(litAt(80.0)).find("for a sun at 60 degrees (the scene's is at 80): a 1"), std::string::npos)
      << told(litAt(80.0));
  Scene dark = litAt(5.0);
  dark.lights.clear();
  dark.octaves.count = 2;
  const std::string none = told(dark);
  EXPECT_NE(none.find("for a sun at 25 degrees (the scene has none): a 0.5"), std::string::npos) << none;
  EXPECT_NE(none.find("(fitted for 6 orders beyond the first, the scene asks for 2)"), std::string::npos)
      << none;
}

TEST(MediumChoice, RefusesMetadataThatIsNoMedium) {
  for (const char* wrong : {"", "thick", "1 2", "-1", "nan", "1 2 x"}) {
    BrickVolume bricks = smallVolume();
    bricks.metadata["sigma_s"] = wrong;
    EXPECT_THROW(chooseMedium(Scene{}, bricks), InputError) << wrong;
  }
}

}  // namespace
}  // namespace nephele
