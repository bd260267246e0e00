// The light cache between pictures that move and pictures at rest.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "preview/gpu/moving.h"
#include "preview/measure/compare.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 48, kHeight = 48;
constexpr double kForever = std::numeric_limits<double>::infinity();

/// A cloud whose voxels are too thick for the cache at rest: moving pictures alone ask for columns.
BrickVolume thickCloud() {
  constexpr int kAcross = 48;
  glm::dmat4 worldFromIndex(1.0);
  for (int axis = 0; axis < 3; ++axis) worldFromIndex[axis] *= 2.0 / kAcross;
  return volumeOf(glm::ivec3(kAcross), glm::ivec3(-kAcross / 2), worldFromIndex,
                  [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 0.49 * kAcross); });
}

ViewedScene litFrom(const glm::dvec3& toLight) {
  ViewedScene view;
  view.camera.position = glm::dvec3(0.0, -4.0, 0.0);
  view.camera.target = glm::dvec3(0.0);
  view.medium = {{60.0, 60.0, 60.0}, {0.0, 0.0, 0.0}, 0.4};
  view.scene.environment.constant = {0.02, 0.02, 0.02};
  Sun sun;
  sun.toLight = toLight;
  view.scene.lights = {sun};
  return view;
}

ViewedScene inMotion(ViewedScene view) {
  view.scene.march = movingMarch(view.scene.march, 1.0);
  return view;
}

shared::MarchParameters parametersOf(const ViewedScene& view, const BrickVolume& bricks,
                                     const BrickAtlas& atlas) {
  return marchParameters(view, bricks, atlas.layout().frame, kWidth, kHeight, 0, false);
}

Picture moved(MarchPass& pass, const BrickVolume& bricks, const BrickAtlas& atlas, const ViewedScene& view) {
  pass.setParameters(parametersOf(view, bricks, atlas));
  EXPECT_TRUE(pass.prepare(atlas, kForever));
  const Film film(kWidth, kHeight);
  pass.draw(atlas, film, {0.5f, 0.5f}, 0, {0, 0, kWidth, kHeight});
  return film.read().picture;
}

// A sun that is let go of before all columns follow it: what is left waits for the next picture that moves.
TEST(GlLightCache, ColumnsThatMovingLeavesAreNotFilledAtRest) {
  needContext();
  const BrickVolume bricks = thickCloud();
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r16f);
  const ViewedScene before = litFrom({0.6, 0.0, 0.8}), after = litFrom({0.0, 0.6, 0.8});
  MarchPass pass(Filter::hardware), fresh(Filter::hardware);
  moved(pass, bricks, atlas, inMotion(before));
  pass.setParameters(parametersOf(inMotion(after), bricks, atlas));
  pass.compile(atlas);  // one block of columns
  const shared::MarchParameters resting = parametersOf(after, bricks, atlas);
  ASSERT_EQ(resting.cache.x, 0.0f) << "at rest it asks for columns as well";
  pass.setParameters(resting);
  EXPECT_TRUE(pass.prepare(atlas, kForever))
      << "a picture at rest waits for columns that it does not ask for";
  const Picture followed = moved(pass, bricks, atlas, inMotion(after));
  const Picture expected = moved(fresh, bricks, atlas, inMotion(after));
  EXPECT_EQ(comparePictures(followed, "followed", expected, "anew").relativeRmse, 0.0);
}

// At rest such a cloud's sky is marched for: what the cache holds of it stays, and is not taken for another
// sky's.
TEST(GlLightCache, ASkyThatChangesAtRestIsKnownToTheNextPictureThatMoves) {
  needContext();
  const BrickVolume bricks = thickCloud();
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r16f);
  ViewedScene before = litFrom({0.6, 0.0, 0.8});
  before.scene.environment.kind = Environment::Kind::ramp;
  before.scene.environment.ramp = {{0.3, 0.2, 0.1}, {0.9, 1.0, 1.1}, {0.1, 0.3, 0.8}, 0.2, 1.5};
  ViewedScene after = before;
  std::swap(after.scene.environment.ramp.ground, after.scene.environment.ramp.zenith);
  MarchPass pass(Filter::hardware), fresh(Filter::hardware);
  moved(pass, bricks, atlas, inMotion(before));
  const uint64_t held = pass.gpuBytes();
  pass.takeCacheDensities();
  const shared::MarchParameters resting = parametersOf(after, bricks, atlas);
  ASSERT_EQ(resting.cacheShape.y, 0) << "at rest it asks for the sky as well";
  pass.setParameters(resting);
  EXPECT_TRUE(pass.prepare(atlas, kForever));
  EXPECT_EQ(pass.takeCacheDensities(), 0.0);
  EXPECT_EQ(pass.gpuBytes(), held);
  const Picture followed = moved(pass, bricks, atlas, inMotion(after));
  const Picture expected = moved(fresh, bricks, atlas, inMotion(after));
  EXPECT_EQ(comparePictures(followed, "followed", expected, "anew").relativeRmse, 0.0);
}

}  // namespace
}  // namespace nephele::testing_gl
