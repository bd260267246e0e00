// The methods beside the march: `dda` against the exact sum over voxels, `cube` against the march, with its
// two defects.
#include <gtest/gtest.h>

#include <algorithm>

#include "preview/measure/compare.h"
#include "preview/resolve.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 64, kHeight = 48;

/// ∫ ρ ds of the density that is constant over each cell i ± ½, in double precision: the ray is cut at every
/// face.
double voxelColumn(const BrickVolume& bricks, const WorldRay& ray) {
  const glm::dmat4 indexFromWorld = glm::inverse(bricks.worldFromIndex);
  const glm::dvec3 o(indexFromWorld * glm::dvec4(ray.origin, 1.0)),
      d(indexFromWorld * glm::dvec4(ray.direction, 0.0));
  std::vector<double> cuts{0.0};
  for (int axis = 0; axis < 3; ++axis)
    for (int face = bricks.activeMin[axis]; face <= bricks.activeMax[axis] && d[axis] != 0.0; ++face) {
      const double t = (face - 0.5 - o[axis]) / d[axis];
      if (t > 0.0) cuts.push_back(t);
    }
  std::sort(cuts.begin(), cuts.end());
  double column = 0.0;
  for (size_t i = 1; i < cuts.size(); ++i) {
    const glm::dvec3 middle = o + 0.5 * (cuts[i - 1] + cuts[i]) * d;
    column += (cuts[i] - cuts[i - 1]) * densityAt(bricks, glm::floor(middle + 0.5));
  }
  return column;
}

FilmPicture render(MarchKind kind, const BrickVolume& bricks, const ViewedScene& view, glm::vec2 subPixel) {
  MarchPass pass(Filter::exact, {}, MarchWrites::radiance, kind);
  pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 0, false));
  return marchOnGpu(pass, bricks, kWidth, kHeight, subPixel, 0);
}

BrickVolume slabs() {
  glm::dmat4 worldFromIndex(1.0);
  worldFromIndex[0] = glm::dvec4(0.05, 0.02, 0.0, 0.0);
  worldFromIndex[1] = glm::dvec4(-0.02, 0.04, 0.01, 0.0);
  worldFromIndex[2] = glm::dvec4(0.0, 0.0, 0.06, 0.0);
  return volumeOf({30, 21, 26}, {-5, 9, 3}, worldFromIndex, [](const glm::dvec3& p) {
    // Sheets of their own density, with gaps as wide as bricks.
    const int sheet = static_cast<int>(p.x) + 5;
    return sheet % 3 == 0 && (sheet < 9 || sheet > 20) ? 0.2 + 0.1 * sheet : 0.0;
  });
}

ViewedScene seen(const BrickVolume& bricks) {
  ViewedScene view;
  view.camera = frameCamera(bricks, glm::dvec3(0, 0, 1), 0.6, static_cast<double>(kWidth) / kHeight);
  view.medium = {{1.5, 1.5, 1.5}, {0.5, 0.5, 0.5}, 0.3};
  view.scene.lights.clear();
  return view;
}

TEST(GlDda, SumsVoxelsExactly) {
  needContext();
  const BrickVolume bricks = slabs();
  const ViewedScene view = seen(bricks);
  const glm::vec2 at(0.31f, 0.77f);
  const Picture picture = render(MarchKind::dda, bricks, view, at).picture;
  const std::vector<float>& transmittance =
      picture.planes[static_cast<size_t>(picture.find("transmittance.G"))];
  double worst = 0.0;
  int crossed = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const WorldRay ray = cameraRay(view.camera, kWidth, kHeight, x + double{at.x}, y + double{at.y});
      const double exact = std::exp(-2.0 * voxelColumn(bricks, ray));
      crossed += exact < 0.99;
      worst = std::max(worst, std::abs(exact - double{transmittance[static_cast<size_t>(y * kWidth + x)]}));
    }
  std::printf("dda: largest error of transmittance over sheets of voxels %.3g, %d rays through them\n", worst,
              crossed);
  EXPECT_GT(crossed, 700);
  EXPECT_LT(worst, 2e-5);
}

TEST(GlCube, IsTheMarchWhereItsRaysStartOnAFaceAndNothingInside) {
  needContext();
  const BrickVolume bricks =
      volumeOf(glm::ivec3(40), glm::ivec3(-3), glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(17.0), 16.0); });
  ViewedScene view = seen(bricks);
  view.medium = {{0.3, 0.3, 0.3}, {0.0, 0.0, 0.0}, 0.4};
  view.scene.lights = {Sun{glm::normalize(glm::dvec3(-1.0, -0.4, 0.8)), {3.0, 3.0, 3.0}}};
  view.scene.march.stepVoxels = 0.25;
  const FilmPicture march = render(MarchKind::march, bricks, view, {0.5f, 0.5f});
  const FilmPicture cube = render(MarchKind::cube, bricks, view, {0.5f, 0.5f});
  const Comparison error = comparePictures(cube.picture, "cube", march.picture, "march");
  std::printf("cube against march: relative RMSE %.3g\n", error.relativeRmse);
  EXPECT_LT(error.relativeRmse, 5e-3);
  const std::vector<float>& transmittance = cube.picture.planes[4];
  EXPECT_EQ(transmittance.front(), 1.0f) << "beside the cube";
  // The known defect: from inside no front face is seen.
  view.camera.position = glm::dvec3(17.0, 17.0, 17.0);
  view.camera.target = glm::dvec3(30.0, 18.0, 17.5);
  const Picture inside = render(MarchKind::cube, bricks, view, {0.5f, 0.5f}).picture;
  EXPECT_EQ(*std::max_element(inside.planes[3].begin(), inside.planes[3].end()), 0.0f);
}

}  // namespace
}  // namespace nephele::testing_gl
