// The debug mode that reads what was skipped: nothing is wrong, and it notices where a bound is broken on
// purpose.
#include <gtest/gtest.h>

#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 64, kHeight = 48;

/// Two balls far apart: most bricks between them are empty.
const BrickVolume& balls() {
  static const BrickVolume bricks =
      volumeOf({120, 60, 60}, glm::ivec3(-7), glm::dmat4(1.0), [](const glm::dvec3& p) {
        return cloudDensity(p, glm::dvec3(13.0, 20.0, 20.0), 16.0) +
               cloudDensity(p, glm::dvec3(92.0, 31.0, 28.0), 14.0);
      });
  return bricks;
}

ViewedScene viewOfBalls(bool cached) {
  ViewedScene view;
  view.camera.target = glm::dvec3(50.0, 25.0, 25.0);
  view.camera.position = glm::dvec3(190.0, 60.0, 60.0);
  view.medium = {{0.3, 0.3, 0.3}, {0.0, 0.0, 0.0}, 0.5};
  view.scene.environment.constant = {0.5, 0.5, 0.5};
  view.scene.lights = {Sun{glm::normalize(glm::dvec3(-1.0, -0.1, -0.05)), {3.0, 3.0, 3.0}}};
  view.scene.march.lightCache = cached;
  view.scene.march.checkSkips = true;
  return view;
}

struct Checked {
  SkipCheck skips;
  FilmPicture film;
};

Checked check(const BrickLayout& layout, const ViewedScene& view) {
  needContext();
  MarchPass pass(Filter::hardware);
  pass.setParameters(marchParameters(view, balls(), layout.frame, kWidth, kHeight, 1, true));
  const BrickAtlas atlas(layout, nullptr, Filter::hardware);
  const Film film(kWidth, kHeight);
  pass.draw(atlas, film, {0.5f, 0.5f}, 0, {0, 0, kWidth, kHeight});
  return {pass.takeSkipCheck(), film.read()};
}

TEST(GlSkips, NothingThatIsSkippedChangesThePicture) {
  for (const Texel texel : {Texel::r32f, Texel::r8})
    for (const bool cached : {false, true}) {
      const BrickLayout layout = layOut(balls(), {texel, kLeastTextureLimit, {}, 0, 0});
      ViewedScene view = viewOfBalls(cached);
      const Checked checked = check(layout, view);
      std::printf("%.4g densities checked, %.0f wrong\n", checked.skips.checked, checked.skips.wrong);
      EXPECT_GT(checked.skips.checked, 20000.0);
      EXPECT_EQ(checked.skips.wrong, 0.0);
      view.scene.march.checkSkips = false;
      const Checked plain = check(layout, view);
      EXPECT_EQ(plain.skips.checked, 0.0);
      EXPECT_EQ(plain.film.picture.planes, checked.film.picture.planes) << "checking changes nothing";
    }
}

TEST(GlSkips, ABrokenBoundIsNoticed) {
  const BrickLayout layout = layOut(balls());
  const auto wrongWith = [&](const auto& tamper) {
    BrickLayout broken = layout;
    for (size_t i = 0; i < broken.words.size(); ++i) tamper(broken.words[i], i);
    return check(broken, viewOfBalls(false)).skips.wrong;
  };
  EXPECT_GT(wrongWith([](glm::uvec2& word, size_t i) {
              if (!brick_word::isEmpty(word) && i % 5 == 0) word = glm::uvec2(0u);
            }),
            0.0)
      << "bricks said to be empty";
  EXPECT_GT(wrongWith([](glm::uvec2& word, size_t) {
              if (brick_word::isEmpty(word)) ++word.y;
            }),
            0.0)
      << "empty cubes said to be larger";
  constexpr uint32_t kHalf = 8;  // codes from a bound to its half
  EXPECT_GT(wrongWith([](glm::uvec2& word, size_t) {
              if (brick_word::maximumCode(word) > kHalf) word.x -= kHalf << brick_word::kMaximumShift;
            }),
            0.0)
      << "maxima half as large";
}

}  // namespace
}  // namespace nephele::testing_gl
