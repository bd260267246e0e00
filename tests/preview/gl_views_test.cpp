// The looks inside (shaders/view.glsl) against the bricks themselves: a slice of the density, the share of a
// ray's way through the box that lies in empty bricks.
#include <gtest/gtest.h>

#include "tests/preview/gl_bench.h"
#include "volume/brick_builder.h"

namespace nephele {
namespace {

using namespace testing_gl;
using glm::dvec3;

constexpr int kWidth = 40, kHeight = 30;

/// Two blobs with much nothing between them, in a rotated world.
BrickVolume twoBlobs() {
  const glm::dmat4 world(glm::dvec4(0.06, 0.08, 0, 0), glm::dvec4(-0.08, 0.06, 0, 0),
                         glm::dvec4(0, 0, 0.1, 0), glm::dvec4(5, 6, 7, 1));
  return volumeOf({64, 40, 40}, {-7, 3, 11}, world, [](const dvec3& p) {
    return std::max(cloudDensity(p, {5, 22, 30}, 9.0), cloudDensity(p, {47, 24, 28}, 7.0));
  });
}

ViewedScene viewOf(const BrickVolume& bricks) {
  ViewedScene view;
  const dvec3 centre(bricks.worldFromIndex * glm::dvec4(25, 23, 31, 1));
  view.camera.target = centre;
  view.camera.position = centre + dvec3(4.0, -9.0, 3.0);
  view.camera.up = dvec3(0.0, 0.0, 1.0);
  return view;
}

Picture pictureOf(MarchPass& pass, const BrickVolume& bricks, const ViewedScene& view) {
  pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 0, false));
  return marchOnGpu(pass, bricks, kWidth, kHeight, {0.5f, 0.5f}, 0).picture;
}

/// A ray in index space, and where it is inside the medium's box; `far` below `near` where it is not.
struct IndexRay {
  dvec3 origin, direction;
  double near = 0.0, far = 1e30;
};

IndexRay indexRay(const BrickVolume& bricks, const ViewedScene& view, int x, int y) {
  const glm::dmat4 indexFromWorld = glm::inverse(bricks.worldFromIndex);
  const WorldRay world = cameraRay(view.camera, kWidth, kHeight, x + 0.5, y + 0.5);
  IndexRay ray{dvec3(indexFromWorld * glm::dvec4(world.origin, 1.0)),
               dvec3(indexFromWorld * glm::dvec4(world.direction, 0.0))};
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (bricks.activeMin[axis] - 1 - ray.origin[axis]) / ray.direction[axis];
    const double b = (bricks.activeMax[axis] - ray.origin[axis]) / ray.direction[axis];
    ray.near = std::max(ray.near, std::min(a, b));
    ray.far = std::min(ray.far, std::max(a, b));
  }
  return ray;
}

TEST(GlViews, SliceShowsTheDensityWhereTheRayMeetsThePlane) {
  needContext();
  const BrickVolume bricks = twoBlobs();
  const ViewedScene view = viewOf(bricks);
  MarchPass pass(Filter::exact, {}, MarchWrites::slice);
  constexpr int kAxis = 1;
  constexpr double kPlace = 22.25;  // index space
  pass.setSlice(kAxis, static_cast<float>(kPlace - double{kBrickCells} * bricks.brickMin[kAxis]));
  const Picture picture = pictureOf(pass, bricks, view);
  int seen = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const IndexRay ray = indexRay(bricks, view, x, y);
      const double t = (kPlace - ray.origin[kAxis]) / ray.direction[kAxis];
      const bool inside = t > ray.near && t < ray.far;
      const size_t i = static_cast<size_t>(y * kWidth + x);
      const double density = inside ? densityAt(bricks, ray.origin + t * ray.direction) : 0.0;
      // Floats along a ray of some hundred voxels, densities that change by at most 1 a voxel.
      EXPECT_NEAR(double{picture.planes[0][i]}, density, 1e-3) << x << ' ' << y;
      EXPECT_EQ(picture.planes[3][i] > 0.5f, inside) << x << ' ' << y;
      seen += density > 0.1 ? 1 : 0;
    }
  EXPECT_GT(seen, 20);
}

TEST(GlViews, SkippedShareIsTheWayThroughEmptyBricks) {
  needContext();
  const BrickVolume bricks = twoBlobs();
  const ViewedScene view = viewOf(bricks);
  MarchPass pass(Filter::exact, {}, MarchWrites::skipped);
  const Picture picture = pictureOf(pass, bricks, view);
  constexpr int kPoints = 4000;  // along each ray
  double least = 1.0, most = 0.0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const IndexRay ray = indexRay(bricks, view, x, y);
      const size_t i = static_cast<size_t>(y * kWidth + x);
      if (!(ray.far > ray.near)) {
        EXPECT_EQ(picture.planes[3][i], 0.0f);
        continue;
      }
      int empty = 0;
      for (int k = 0; k < kPoints; ++k) {
        const double t = ray.near + (k + 0.5) / kPoints * (ray.far - ray.near);
        const glm::ivec3 brick(glm::floor((ray.origin + t * ray.direction) / double{kBrickCells}));
        const int64_t entry = indexOf(bricks, brick);
        empty += entry < 0 || bricks.index[static_cast<size_t>(entry)] == 0 ? 1 : 0;
      }
      const double share = static_cast<double>(empty) / kPoints;
      // A ray crosses a dozen faces, each of which the points place to within one of them.
      EXPECT_NEAR(double{picture.planes[0][i]}, share, 12.0 / kPoints) << x << ' ' << y;
      least = std::min(least, share);
      most = std::max(most, share);
    }
  EXPECT_LT(least, 0.8);
  EXPECT_GT(most, 0.99);
}

}  // namespace
}  // namespace nephele
