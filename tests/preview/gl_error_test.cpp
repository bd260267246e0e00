// The march against the reference: sparse pictures are those of the whole, --error keeps its word, and
// defaults are near single-scattering truth.
#include <gtest/gtest.h>

#include "preview/gpu/march_method.h"
#include "preview/measure/error_request.h"
#include "preview/truth/reference_method.h"
#include "tests/preview/clouds.h"

namespace nephele {
namespace {

using testing_clouds::cloudDensity;
using testing_clouds::volumeOf;

/// A bumpy ball of 64 voxels across and about 8 optical depths, lit by a sun from the side.
struct Lit {
  BrickVolume bricks;
  ViewedScene view;
  std::unique_ptr<Method> march = makeMarchMethod({}), truth = makeReferenceMethod({});

  Lit() {
    constexpr double kVoxel = 1.0 / 32.0;
    glm::dmat4 worldFromIndex(kVoxel);
    worldFromIndex[3][3] = 1.0;
    bricks = volumeOf(glm::ivec3(66), glm::ivec3(-33), worldFromIndex,
                      [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 32.0); });
    view.camera.position = {0.8, -4.0, 0.6};
    view.medium = {{7.0, 8.0, 9.0}, {0.0, 0.0, 0.0}, 0.5};
    march->setVolume(bricks);
    truth->setVolume(bricks);
  }
  static PictureRequest request(int width, int height, unsigned samples) {
    PictureRequest request;
    request.width = width;
    request.height = height;
    request.samples = samples;
    request.quiet = true;
    request.bounces = 0;
    return request;
  }
};

TEST(GlError, SparsePicturesAreThoseOfTheWhole) {
  Lit lit;
  constexpr int kStride = 5;
  PictureRequest request = Lit::request(83, 62, 16);  // neither is a multiple of the stride
  PictureCost cost;
  const Picture whole = lit.truth->render(lit.view, request, cost);
  const Picture marched = lit.march->render(lit.view, request, cost);
  request.stride = kStride;
  const Picture sparse = lit.truth->render(lit.view, request, cost);
  const Picture sparseMarched = lit.march->render(lit.view, request, cost);
  ASSERT_EQ(sparse.width, 17);
  ASSERT_EQ(sparse.height, 12);
  size_t at = 0, seen = 0;
  for (int y = kStride / 2; y < whole.height; y += kStride)
    for (int x = kStride / 2; x < whole.width; x += kStride, ++at) {
      const size_t in = static_cast<size_t>(y) * static_cast<size_t>(whole.width) + static_cast<size_t>(x);
      for (size_t plane = 0; plane < 3; ++plane)
        EXPECT_EQ(sparse.planes[plane][at], whole.planes[plane][in]) << x << ' ' << y;
      EXPECT_NEAR(sparseMarched.planes[3][at], marched.planes[3][in], 0.02) << x << ' ' << y;
      seen += marched.planes[3][in] > 0.5f ? 1 : 0;
    }
  EXPECT_GT(seen, 30u);
}

TEST(GlError, KeepsItsWordAgainstTruthOfItsOwn) {
  Lit lit;
  const PictureRequest request = Lit::request(80, 60, 1);
  PictureRequest asked = request;
  asked.seed = 9;
  asked.error = 0.02;
  PictureCost cost;
  const Picture truth = lit.truth->render(lit.view, asked, cost);
  double before = 0.0;
  for (const double error : {0.1, 0.03, 0.01}) {
    ErrorSearch search(*lit.march, *lit.truth, lit.view, request);
    const ErrorPick pick = search.pick(error);
    const bool marches = pick.setting.method == "march";
    asked = request;
    asked.samples = pick.setting.samples;
    asked.error = marches ? 0.0 : error;
    Method& method = marches ? *lit.march : *lit.truth;
    const Picture picture = method.render(withSetting(lit.view, pick.setting), asked, cost);
    const NoisyError measured = compareWithHalves(picture, truth);
    std::printf("asked %.3g: %s, expected %.3g in %.4g ms, measured %.3g (%.3g to %.3g) in %.4g ms\n", error,
                pick.setting.name.c_str(), pick.error, pick.milliseconds, measured.relativeRmse, measured.low,
                measured.high, cost.milliseconds);
    EXPECT_LE(measured.relativeRmse, error);
    // Work is counted, not timed; that of the two methods is not alike.
    if (!marches) continue;
    EXPECT_GE(pick.work, before) << "a looser error was dearer";
    before = pick.work;
  }
}

TEST(GlError, TheStageIsThatOfTruth) {
  // Highlights and penumbras have no truth. Things stand where they do not shade the cloud, which the march
  // leaves out.
  Lit lit;
  lit.view.scene.lights = {Sun{glm::normalize(glm::dvec3(-0.3, -0.4, 1.0)), {3.0, 3.0, 3.0}}};
  lit.view.camera.position = {0.8, -6.0, 2.5};
  lit.view.camera.target = {0.0, 0.0, -0.4};
  Stage& stage = lit.view.scene.stage;
  stage.on = true;
  stage.cube.on = true;
  stage.highlights = false;
  stage.penumbra = 0.0;
  stage.checker = 3.0;  // squares that pixels resolve: the march fades smaller ones
  PictureRequest request = Lit::request(96, 64, 256);
  PictureCost cost;
  const Picture marched = lit.march->render(lit.view, request, cost);
  request.error = 0.02;
  const Picture truth = lit.truth->render(lit.view, request, cost);
  const NoisyError error = compareWithHalves(marched, truth);
  std::printf("stage: %.3g (%.3g to %.3g), bias %.3g\n", error.relativeRmse, error.low, error.high,
              error.bias);
  EXPECT_LE(error.relativeRmse, 0.03);
}

TEST(GlError, TheMarchAtItsDefaultsIsNearSingleScattering) {
  Lit lit;
  constexpr double kThin = 1.0, kDense = 6.0;  // dense: more than half an optical depth a voxel in its middle
  for (const double times : {kThin, kDense}) {
    ViewedScene view = lit.view;
    for (double& sigma : view.medium.sigmaS) sigma *= times;
    PictureRequest request = Lit::request(64, 48, 256);  // twice as many move the figure by less than a tenth
    PictureCost cost;
    const Picture marched = lit.march->render(view, request, cost);
    request.error = 0.02;
    request.seed = 5;
    const NoisyError error = compareWithHalves(marched, lit.truth->render(view, request, cost));
    std::printf("density x %g: %.3g (%.3g to %.3g)\n", times, error.relativeRmse, error.low, error.high);
    EXPECT_LE(error.relativeRmse, 0.02) << times;
  }
}

}  // namespace
}  // namespace nephele
