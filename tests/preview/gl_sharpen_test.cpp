// A small picture that was sharpened comes nearer to the large one when it is enlarged, and says the same of
// samples and depth.
#include <gtest/gtest.h>

#include "base/enlarge.h"
#include "preview/gpu/sharpen.h"
#include "preview/gpu/sub_pixels.h"
#include "preview/measure/compare.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kSmall = 48, kSamples = 8;

ViewedScene view() {
  ViewedScene view;
  view.camera.target = glm::dvec3(0.0);
  view.camera.position = glm::dvec3(90.0, -120.0, 40.0);
  view.camera.fov = 0.42;
  view.medium = {{0.6, 0.6, 0.6}, {0.0, 0.0, 0.0}, 0.4};
  return view;
}

void accumulate(MarchPass& pass, const BrickVolume& bricks, const BrickAtlas& atlas, const Film& film) {
  pass.setParameters(marchParameters(view(), bricks, film.width(), film.height(), 5, true));
  for (unsigned i = 0; i < kSamples; ++i)
    pass.draw(atlas, film, subPixelOffset(i, 5), i, {0, 0, film.width(), film.height()});
}

TEST(GlSharpen, AnEnlargedPictureComesNearerToTheLargeOne) {
  needContext();
  const BrickVolume bricks =
      volumeOf(glm::ivec3(64), glm::ivec3(-32), glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 30.0); });
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r32f);
  MarchPass pass(Filter::hardware);
  const Film large(2 * kSmall, 2 * kSmall), small(kSmall, kSmall), sharp(kSmall, kSmall);
  accumulate(pass, bricks, atlas, large);
  accumulate(pass, bricks, atlas, small);
  SharpenPass().draw(small, sharp);
  const FilmPicture before = small.read(), after = sharp.read();
  const Picture reference = large.read().picture;
  const auto error = [&](const Picture& picture) {
    return comparePictures(enlarged(picture, 2 * kSmall, 2 * kSmall), "enlarged", reference, "large")
        .relativeRmse;
  };
  std::printf("enlarged by two: relative RMSE %.4f as it is, %.4f sharpened\n", error(before.picture),
              error(after.picture));
  EXPECT_LT(error(after.picture), 0.8 * error(before.picture));
  EXPECT_EQ(after.densitySamples, before.densitySamples);
  const size_t depth = static_cast<size_t>(after.picture.find("depth"));
  EXPECT_EQ(after.picture.planes[depth], before.picture.planes[depth]);
  const auto within = [](const std::vector<float>& plane, float most) {
    return std::all_of(plane.begin(), plane.end(), [most](float x) { return x >= 0.0f && x <= most; });
  };
  for (const char* name : {"A", "transmittance.R", "transmittance.G", "transmittance.B"})
    EXPECT_TRUE(within(after.picture.planes[static_cast<size_t>(after.picture.find(name))], 1.0f)) << name;
}

TEST(GlSharpen, WhatIsEvenStaysAsItIs) {
  needContext();
  const BrickVolume none;
  const BrickAtlas atlas(none, Filter::hardware, Texel::r32f);
  MarchPass pass(Filter::hardware);
  ViewedScene sky = view();
  sky.scene.environment.constant = {0.3, 0.4, 0.5};
  sky.scene.environment.show = true;
  pass.setParameters(marchParameters(sky, none, kSmall, kSmall, 5, true));
  const Film film(kSmall, kSmall), sharp(kSmall, kSmall);
  pass.draw(atlas, film, {0.5f, 0.5f}, 0, {0, 0, kSmall, kSmall});
  SharpenPass().draw(film, sharp);
  const Picture picture = sharp.read().picture;
  for (const float green : picture.planes[1]) ASSERT_NEAR(green, 0.4f, 1e-6f);
  for (const float through : picture.planes[4]) ASSERT_EQ(through, 1.0f);
}

}  // namespace
}  // namespace nephele::testing_gl
