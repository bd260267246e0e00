// Any affine transform, any distance from the origin, a camera inside: transmittance against the integral
// along the ray taken through the transform in double precision. And volumes with nothing in them.
#include <gtest/gtest.h>

#include "preview/resolve.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 64, kHeight = 48;
const glm::ivec3 kSize(40, 28, 33);
const glm::ivec3 kOrigin(-1005, 37, -8);

double density(const glm::dvec3& p) {
  // No symmetry, so that a mirrored or exchanged axis shows.
  const glm::dvec3 q = p - glm::dvec3(kOrigin);
  return cloudDensity(q, glm::dvec3(17.0, 12.0, 15.0), 15.0) +
         (q.x > 30.0 && q.y > 18.0 && q.z < 9.0 ? 0.8 : 0.0);
}

glm::dmat4 rotatedShearedUnequal(double scale, const glm::dvec3& place) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const glm::dmat3 rotation(glm::dvec3(c, s * 0.6, s * 0.8), glm::dvec3(-s, c * 0.6, c * 0.8),
                            glm::dvec3(0.0, -0.8, 0.6));
  const glm::dmat3 shear(glm::dvec3(1, 0, 0), glm::dvec3(0.4, 1, 0), glm::dvec3(-0.2, 0.3, 1));
  const glm::dmat3 sides(glm::dvec3(1.0, 0, 0), glm::dvec3(0, 2.5, 0), glm::dvec3(0, 0, 0.6));
  glm::dmat4 result(scale * (rotation * shear * sides));
  result[3] = glm::dvec4(place, 1.0);
  return result;
}

/// Pixels through whose medium less than this comes count as seeing it.
constexpr double kSeen = 0.99;
/// An error is looked for along so many rays at least: a twentieth of the picture.
constexpr int kLeastSeen = kWidth * kHeight / 20;

/// Largest difference of transmittance from the exact one over the picture. As many pixels see the medium as
/// the exact integral says, but for those at the very limit; they are kLeastSeen or more.
double worstError(const BrickVolume& bricks, const Camera& camera, double depthAcross) {
  const double sigmaT = chooseMedium(Scene{}, bricks).medium.sigmaS[0] * depthAcross / 8.0;
  const std::vector<float> transmittance = transmittanceOnGpu(bricks, camera, sigmaT, kWidth, kHeight);
  double worst = 0.0;
  int seen = 0, shown = 0, inDoubt = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double exact =
          std::exp(-sigmaT * exactColumn(bricks, cameraRay(camera, kWidth, kHeight, x + 0.5, y + 0.5)));
      const double marched = double{transmittance[static_cast<size_t>(y * kWidth + x)]};
      seen += exact < kSeen;
      shown += marched < kSeen;
      inDoubt += std::abs(exact - kSeen) < 1e-3;  // the error that is allowed
      worst = std::max(worst, std::abs(exact - marched));
    }
  EXPECT_GE(seen, kLeastSeen);
  EXPECT_NEAR(shown, seen, inDoubt);
  return worst;
}

void expectPlaced(double scale, const glm::dvec3& place, const char* name) {
  needContext();
  const BrickVolume bricks = volumeOf(kSize, kOrigin, rotatedShearedUnequal(scale, place), density);
  const Camera framed = frameCamera(bricks, glm::dvec3(0, 0, 1), 0.6, static_cast<double>(kWidth) / kHeight);
  const double outside = worstError(bricks, framed, 3.0);
  EXPECT_LT(outside, 1e-3) << name;
  Camera inside = framed;
  inside.position =
      glm::dvec3(bricks.worldFromIndex * glm::dvec4(glm::dvec3(kOrigin) + glm::dvec3(16.0, 11.0, 14.0), 1.0));
  inside.target = inside.position + (framed.target - framed.position) + glm::dvec3(0.1 * scale);
  inside.fov = 1.4;
  const double within = worstError(bricks, inside, 3.0);
  EXPECT_LT(within, 1e-3) << name;
  Camera far = framed;
  far.position = framed.target + 1e4 * (framed.position - framed.target);
  far.fov = 2.0 * std::atan(1e-4 * std::tan(0.5 * framed.fov));
  const double distant = worstError(bricks, far, 3.0);
  EXPECT_LT(distant, 1e-3) << name;
  std::printf("%s: largest error of transmittance outside %.3g, inside %.3g, from 10^4 away %.3g\n", name,
              outside, within, distant);
}

TEST(GlPlacement, RotatedShearedUnequalSides) {
  expectPlaced(0.05, {3.0, -2.0, 1.0}, "rotated, sheared, unequal");
}
TEST(GlPlacement, MillionUnitsFromTheOrigin) {
  expectPlaced(0.05, {1e6, -1e6, 2e6}, "10^6 units from the origin");
}
TEST(GlPlacement, TinyAndHugeWorlds) {
  expectPlaced(1e-6, {0.0, 0.0, 0.0}, "voxels of 10^-6");
  expectPlaced(1e6, {0.0, 0.0, 0.0}, "voxels of 10^6");
}

TEST(GlPlacement, EmptyVolumeIsAPictureOfNothing) {
  needContext();
  const BrickVolume bricks =
      volumeOf(glm::ivec3(4), glm::ivec3(0), glm::dmat4(1.0), [](const glm::dvec3&) { return 0.0; });
  ASSERT_TRUE(bricks.empty());
  ViewedScene view;
  view.camera = frameCamera(bricks, glm::dvec3(0, 0, 1), 0.6, 1.0);
  MarchPass pass(Filter::hardware);
  pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 0, true));
  const Picture picture = marchOnGpu(pass, bricks, kWidth, kHeight, {0.5f, 0.5f}, 0).picture;
  for (size_t plane = 0; plane < 4; ++plane)
    for (float value : picture.planes[plane]) ASSERT_EQ(value, 0.0f);
}

TEST(GlPlacement, HardwareFilterIsNearTheExactOne) {
  needContext();
  const BrickVolume bricks = volumeOf(kSize, kOrigin, glm::dmat4(1.0), density);
  ViewedScene view;
  view.camera = frameCamera(bricks, glm::dvec3(0, 0, 1), 0.6, static_cast<double>(kWidth) / kHeight);
  view.medium = chooseMedium(Scene{}, bricks).medium;
  Picture pictures[2];
  for (int i = 0; i < 2; ++i) {
    MarchPass pass(i == 0 ? Filter::exact : Filter::hardware);
    pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 0, true));
    pictures[i] = marchOnGpu(pass, bricks, kWidth, kHeight, {0.5f, 0.5f}, 0).picture;
  }
  double worst = 0.0;
  for (size_t i = 0; i < pictures[0].planes[3].size(); ++i)
    worst = std::max(worst, std::abs(double{pictures[0].planes[3][i]} - double{pictures[1].planes[3][i]}));
  std::printf("hardware filter against exact: largest difference of alpha %.3g\n", worst);
  // Weights of 8 bits move a sample by up to 1/512 voxel; half a texel off would show as 0.1 and more.
  EXPECT_LT(worst, 0.02);
}

TEST(LongRays, AreRightOrSaidToBeCutShort) {
  needContext();
  // A hundredth of a voxel on the way and towards the sun: 6400 steps, each with thousands more. llvmpipe
  // ends all loops of a pixel after 65535 turns, without a word.
  const BrickVolume bricks =
      bricksFromDense(std::vector<float>(64 * 64 * 64, 1.0f), glm::ivec3(64), glm::ivec3(0), glm::dmat4(1.0));
  ViewedScene view;
  view.camera.target = glm::dvec3(31.5);
  view.camera.position = glm::dvec3(31.5, 31.5, 400.0);
  view.camera.up = glm::dvec3(0.0, 1.0, 0.0);
  view.medium = {{0.01, 0.01, 0.01}, {0.0, 0.0, 0.0}, 0.0};
  view.scene.march = {0.01, 0.01, 1.0, false, false};
  view.scene.march.stepPixels = 0.0;
  MarchPass pass(Filter::exact);
  pass.setParameters(marchParameters(view, bricks, 1, 1, 0, false));
  const FilmPicture film = marchOnGpu(pass, bricks, 1, 1, {0.5f, 0.5f}, 0);
  // 64 voxels at full density: 63 between samples and half a voxel's worth at either end.
  const double exact = 1.0 - std::exp(-0.01 * 64.0);
  double worst = 0.0;
  for (const float alpha : film.picture.planes[3]) worst = std::max(worst, std::abs(double{alpha} - exact));
  std::printf("long rays: %.0f of 1 cut short, largest error of alpha %.3g\n", film.raysCutShort, worst);
  EXPECT_TRUE(film.raysCutShort == 1.0 || worst < 2e-3);
  if (glRenderer().find("llvmpipe") != std::string::npos) {
    EXPECT_EQ(film.raysCutShort, 1.0);
  }
}

}  // namespace
}  // namespace nephele::testing_gl
