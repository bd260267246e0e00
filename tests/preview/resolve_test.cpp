// Framing, up axis and the medium's three sources.
#include "preview/resolve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

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

TEST(MediumChoice, RefusesMetadataThatIsNoMedium) {
  for (const char* wrong : {"", "thick", "1 2", "-1", "nan", "1 2 x"}) {
    BrickVolume bricks = smallVolume();
    bricks.metadata["sigma_s"] = wrong;
    EXPECT_THROW(chooseMedium(Scene{}, bricks), InputError) << wrong;
  }
}

}  // namespace
}  // namespace nephele
