// Orbit, pan and zoom against closed forms.
#include "preview/app/orbit_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace nephele {
namespace {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;
constexpr double kTight = 1e-12;

Camera sideCamera() {
  Camera camera;
  camera.position = dvec3(5.0, 1.0, 1.0);
  camera.target = dvec3(1.0, 1.0, 1.0);
  camera.up = dvec3(0.0, 0.0, 1.0);
  camera.fov = 0.5 * kPi;
  return camera;
}

void expectNear(const dvec3& actual, const dvec3& expected) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], kTight) << "axis " << axis;
}

TEST(OrbitCamera, KeepsTheCameraItStartsFrom) {
  Camera camera = sideCamera();
  camera.position = dvec3(-2.0, 3.0, 0.5);
  camera.up = dvec3(0.0, 1.0, 0.0);
  const Camera back = OrbitCamera(camera).camera();
  expectNear(back.position, camera.position);
  expectNear(back.target, camera.target);
  EXPECT_EQ(back.fov, camera.fov);
}

TEST(OrbitCamera, QuarterTurnAboutZGoesFromXToY) {
  OrbitCamera orbit(sideCamera());
  orbit.orbit(0.5 * kPi, 0.0);
  expectNear(orbit.camera().position, dvec3(1.0, 5.0, 1.0));
  orbit.orbit(1.5 * kPi, 0.0);
  expectNear(orbit.camera().position, dvec3(5.0, 1.0, 1.0));
}

TEST(OrbitCamera, ElevationRisesAndStopsShortOfUp) {
  OrbitCamera orbit(sideCamera());
  orbit.orbit(0.0, kPi / 6.0);
  expectNear(orbit.camera().position, dvec3(1.0 + 4.0 * std::cos(kPi / 6.0), 1.0, 3.0));
  orbit.orbit(0.0, 10.0);
  const double height = 4.0 * std::sin(OrbitCamera::kMostElevation);
  EXPECT_NEAR(orbit.camera().position.z, 1.0 + height, kTight);
}

TEST(OrbitCamera, PanMovesThePictureByItsHeight) {
  // At 90 degrees the picture is twice as high as the target is far: 8. Looking along −x, right is +y.
  OrbitCamera orbit(sideCamera());
  orbit.pan(0.25, 0.0);
  expectNear(orbit.camera().target, dvec3(1.0, 1.0 - 2.0, 1.0));
  orbit.pan(-0.25, 0.5);
  expectNear(orbit.camera().target, dvec3(1.0, 1.0, 1.0 - 4.0));
  expectNear(orbit.camera().position - orbit.camera().target, dvec3(4.0, 0.0, 0.0));
}

TEST(OrbitCamera, ZoomScalesTheDistance) {
  OrbitCamera orbit(sideCamera());
  orbit.zoom(0.25);
  expectNear(orbit.camera().position, dvec3(2.0, 1.0, 1.0));
}

TEST(OrbitCamera, LooksAroundFromWhereItStands) {
  OrbitCamera orbit(sideCamera());
  orbit.look(0.5 * kPi, 0.0);
  expectNear(orbit.camera().position, dvec3(5.0, 1.0, 1.0));
  expectNear(orbit.camera().target, dvec3(5.0, -3.0, 1.0));
}

TEST(OrbitCamera, FliesAlongItsOwnAxes) {
  // It looks along −x: forward is −x, right is +y.
  OrbitCamera orbit(sideCamera());
  orbit.fly(1.0, 2.0, 3.0);
  expectNear(orbit.camera().position, dvec3(4.0, 3.0, 4.0));
  expectNear(orbit.camera().target, dvec3(0.0, 3.0, 4.0));
}

TEST(OrbitCamera, FocusPutsAPointInTheMiddleWithoutTurning) {
  OrbitCamera orbit(sideCamera());
  orbit.focus(dvec3(3.0, 2.0, 0.0));
  expectNear(orbit.camera().target, dvec3(3.0, 2.0, 0.0));
  expectNear(orbit.camera().position, dvec3(5.0, 2.0, 0.0));
  orbit.focus(dvec3(6.0, 2.0, 0.0));  // behind it
  expectNear(orbit.camera().target, dvec3(3.0, 2.0, 0.0));
}

TEST(OrbitCamera, RaysGoThroughThePicture) {
  const Camera camera = sideCamera();  // 90 degrees, along −x
  expectNear(rayThrough(camera, 0.5, 0.5, 2.0), dvec3(-1.0, 0.0, 0.0));
  expectNear(rayThrough(camera, 0.5, 0.0, 2.0), glm::normalize(dvec3(-1.0, 0.0, 1.0)));
  expectNear(rayThrough(camera, 1.0, 0.5, 2.0), glm::normalize(dvec3(-1.0, 2.0, 0.0)));
}

TEST(Angles, RoundTripAboutAnyUp) {
  for (const dvec3& up : {dvec3(0, 0, 1), dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(0.6, 0.0, 0.8)}) {
    const dvec3 direction = glm::normalize(dvec3(0.3, 0.8, -0.5));
    expectNear(directionOf(anglesOf(direction, up), up), direction);
  }
  const Angles overhead = anglesOf(dvec3(0.0, 0.0, 2.0), dvec3(0.0, 0.0, 1.0));
  EXPECT_NEAR(overhead.elevation, 0.5 * kPi, kTight);
}

}  // namespace
}  // namespace nephele
