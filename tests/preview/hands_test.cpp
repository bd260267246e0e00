// What hands do, as arithmetic: the sun's drag, keys, bookmarks, scales, noise at rest, saved scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <set>

#include "preview/app/bookmarks.h"
#include "preview/app/frame_pace.h"
#include "preview/app/keys.h"
#include "preview/app/noise_estimate.h"
#include "preview/app/scene_file.h"
#include "preview/app/sun_drag.h"
#include "preview/app/views.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

using glm::dvec3;
constexpr double kTight = 1e-12;
const dvec3 kUp(0.0, 0.0, 1.0);

TEST(SunDrag, AHeightIsHalfATurn) {
  const dvec3 turned = dragSun(dvec3(1.0, 0.0, 0.0), kUp, 0.5, 0.0);
  EXPECT_NEAR(turned.x, 0.0, kTight);
  EXPECT_NEAR(turned.y, 1.0, kTight);
}

TEST(SunDrag, TheLitSideFollowsTheHand) {
  // The camera looks along +y, right is +x; the sun is behind it. Dragged right and up it goes right and up.
  const dvec3 turned = dragSun(dvec3(0.0, -1.0, 0.0), kUp, 0.1, -0.1);
  EXPECT_GT(turned.x, 0.0);
  EXPECT_GT(turned.z, 0.0);
}

TEST(SunDrag, StopsAtTheZenithAndComesBackTheSameWay) {
  const dvec3 start = glm::normalize(dvec3(0.3, 0.5, 0.4));
  const dvec3 top = dragSun(start, kUp, 0.0, -2.0);
  EXPECT_NEAR(top.z, 1.0, 1e-7);
  const dvec3 back = dragSun(top, kUp, 0.0, 0.5 - std::asin(start.z) / std::numbers::pi);
  EXPECT_NEAR(glm::length(back - start), 0.0, 1e-3);  // it stopped a hair short of the zenith
  EXPECT_NEAR(glm::length(dragSun(start, dvec3(0, 2, 0), 0.3, 0.2)), 1.0, kTight);
}

TEST(Keys, NoKeyMeansTwoThings) {
  std::set<std::tuple<int, bool, bool>> seen;
  for (const KeyRow& row : keyRows()) {
    if (!row.action) continue;
    EXPECT_TRUE(seen.emplace(row.press.key, row.press.control, row.press.shift).second) << row.what;
    EXPECT_EQ(bookmarkOf(row.press), 0);
  }
}

TEST(Keys, EveryActionIsListedUnderF1) {
  std::set<Action> listed;
  for (const KeyRow& row : keyRows())
    if (row.action) listed.insert(*row.action);
  EXPECT_EQ(listed.size(), static_cast<size_t>(Action::help) + 1);
}

TEST(Keys, UndoAndRedo) {
  EXPECT_EQ(actionOf({'Z', true, false}), Action::undo);
  EXPECT_EQ(actionOf({'Z', true, true}), Action::redo);
  EXPECT_EQ(actionOf({'Z', false, false}), std::nullopt);
}

TEST(Bookmarks, AreSetAndFound) {
  EXPECT_EQ(bookmarkOf({'3', false, false}), 3);
  EXPECT_EQ(bookmarkOf({'3', true, false}), 3);
  EXPECT_EQ(bookmarkOf({'0', false, false}), 0);
  Bookmarks bookmarks;
  EXPECT_FALSE(bookmarks.get(9));
  Camera camera;
  camera.fov = 0.25;
  bookmarks.set(9, camera);
  EXPECT_EQ(bookmarks.get(9)->fov, 0.25);
  EXPECT_FALSE(bookmarks.get(1));
}

TEST(Scale, EndsAtRoundNumbers) {
  EXPECT_EQ(scaleFor({}), 1.0);
  EXPECT_EQ(scaleFor({0.0f, -1.0f, NAN}), 1.0);
  EXPECT_DOUBLE_EQ(scaleFor({3.0f}), 5.0);
  EXPECT_DOUBLE_EQ(scaleFor({0.7f, 0.15f}), 0.2);  // of two values the lower is the 99th percentile
  EXPECT_DOUBLE_EQ(scaleFor({700.0f}), 1000.0);
  std::vector<float> values(1000, 4.0f);
  values.push_back(1e6f);  // one hot pixel does not stretch it
  EXPECT_DOUBLE_EQ(scaleFor(values), 5.0);
}

TEST(Noise, IsTheErrorOfTheMean) {
  // Samples of mean 2 and standard deviation 0.5: the mean of 64 errs by 0.5/8, relative to 2: 3.1%.
  constexpr unsigned kCount = 64;
  constexpr size_t kPixels = 20000;
  std::mt19937 random(1);
  std::normal_distribution<float> sample(2.0f, 0.5f);
  std::vector<float> half(4 * kPixels), all(4 * kPixels);
  for (size_t i = 0; i < half.size(); ++i) {
    for (unsigned n = 0; n < kCount; ++n) {
      const float value = i % 4 == 3 ? 1.0f : sample(random);
      all[i] += value;
      if (n < kCount / 2) half[i] += value;
    }
  }
  // Of 60000 channel values the estimate's own relative deviation is 1/√120000 = 0.3%; five of them.
  EXPECT_NEAR(relativeNoise(half, all, kCount), 0.03125, 0.03125 * 0.015);
}

TEST(Noise, LeavesOutWhatIsNotCloudAndChannelsWithoutLight) {
  // One pixel of cloud with halves 1 and 3 in red alone, one of sky with wild values.
  const std::vector<float> half{1, 0, 0, 1, 100, 0, 0, 0}, all{4, 0, 0, 2, 100, 0, 0, 0};
  EXPECT_DOUBLE_EQ(relativeNoise(half, all, 2), 0.5);  // |1 − 3|/2 over a mean of 2
  EXPECT_EQ(relativeNoise({}, {}, 2), 0.0);
}

TEST(Noise, SamplesFollowFromIt) {
  EXPECT_EQ(samplesFor(0.04, 16, 0.01, 4096), 256u);
  EXPECT_EQ(samplesFor(0.001, 16, 0.01, 4096), 16u);
  EXPECT_EQ(samplesFor(1.0, 16, 0.01, 4096), 4096u);
}

TEST(SceneFile, ReadsBackWhatWasSaved) {
  const ScratchFolder folder;
  const std::string path = sceneFileFor(folder.path(), "/else/where/cumulus.vdb");
  EXPECT_EQ(path, folder.file("cumulus.scene.yaml"));
  Settings settings;
  settings.medium.g = 0.25;
  settings.medium.sigmaS = {1.0, 2.0, 3.0};
  settings.scene.look = Look::report;
  settings.scene.march.stepVoxels = 0.75;
  Camera camera;
  camera.position = dvec3(5.0, 6.0, 7.0);
  settings.scene.octaves = {5, 0.45, 0.57, 0.25};
  saveScene(path, settings, camera, false);
  const Scene back = loadScene(path);
  EXPECT_EQ(back.medium->g, 0.25);
  EXPECT_EQ(back.medium->sigmaS, settings.medium.sigmaS);
  EXPECT_EQ(back.camera->position, camera.position);
  EXPECT_EQ(back.look, Look::report);
  EXPECT_EQ(back.march.stepVoxels, 0.75);
  EXPECT_EQ(back.octaves.a, 0.45);
  EXPECT_EQ(back.octaves.b, 0.57);
  EXPECT_EQ(back.octaves.c, 0.25);
  saveScene(path, settings, camera, true);  // over itself
  EXPECT_FALSE(loadScene(path).octaves.factorsGiven)
      << "factors fitted to the file would no longer follow the sun";
}

TEST(SceneFile, LeavesARecipeAlone) {
  const ScratchFolder folder;
  const std::string path = folder.write("a.scene.yaml", "assets: {}\nscene: { look: physical }\n");
  EXPECT_THROW(saveScene(path, {}, {}, false), InputError);
}

TEST(FramePace, CountsFramesOfTheLastRunAlone) {
  FramePace pace;
  EXPECT_EQ(pace.perSecond(), 0.0);
  EXPECT_EQ(pace.medianSeconds(), 0.0);
  for (int i = 0; i < 11; ++i) pace.shown(1.0 + 0.05 * i);
  EXPECT_EQ(pace.frames(), 11u);
  EXPECT_NEAR(pace.perSecond(), 20.0, 1e-9);
  EXPECT_NEAR(pace.medianSeconds(), 0.05, 1e-9);
  // A second of rest is no frame. Of three times one is long: the mean knows, the median does not.
  const double after = 2.5;
  for (const double at : {0.0, 0.01, 0.02, 0.13}) pace.shown(after + at);
  EXPECT_EQ(pace.frames(), 4u);
  EXPECT_NEAR(pace.perSecond(), 3.0 / 0.13, 1e-9);
  EXPECT_NEAR(pace.medianSeconds(), 0.01, 1e-9);
}

TEST(FramePace, KeepsTheNewestTimes) {
  FramePace pace;
  double now = 0.0;
  for (int i = 0; i < 1000; ++i) pace.shown(now += 0.2);
  for (int i = 0; i < 1025; ++i) pace.shown(now += 0.01);
  EXPECT_NEAR(pace.medianSeconds(), 0.01, 1e-9) << "of the 1024 newest";
}

}  // namespace
}  // namespace nephele
