// --error on methods whose errors and costs are known: it keeps its word, a looser one is never dearer, and
// the reference is picked where no march gets there.
#include "preview/measure/error_request.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "preview/truth/random.h"

namespace nephele {
namespace {

constexpr double kRadiance = 2.0;
constexpr double kMillisecondsOfWork = 1e-6;

/// Normal numbers by Box and Muller.
class Normal {
 public:
  explicit Normal(uint64_t seed) : random_(seed) {}
  double operator()() {
    const double r = std::sqrt(2.0 * double{random_.exponential()});
    return r * std::cos(6.283185307179586 * double{random_.uniform()});
  }

 private:
  truth::Random random_;
};

Picture evenPicture(const PictureRequest& request, const std::vector<std::string>& names) {
  Picture picture;
  picture.width = strided(request.width, request.stride);
  picture.height = strided(request.height, request.stride);
  for (const std::string& name : names) picture.add(name);
  picture.planes[3].assign(picture.planes[3].size(), 1.0f);
  return picture;
}

/// Errs by a bias that grows with steps and the cache's cells, and by noise that falls with samples. Its
/// clock is off by a factor of up to `clock`, another one each time.
class KnownMarch : public Method {
 public:
  static double bias(const MarchSettings& march) {
    return 0.004 * march.stepVoxels + (march.lightCache ? 0.006 * march.cacheVoxels : 0.0);
  }
  static double noise(unsigned samples) { return 0.08 / std::sqrt(static_cast<double>(samples)); }
  static double densitiesOfRay(const MarchSettings& march) {
    return 100.0 / march.stepVoxels * (march.lightCache ? 1.0 : 5.0);
  }
  static double work(const Setting& setting, double pixels) {
    const double rays = pixels * setting.samples;
    return workOf(setting, 0.0, rays * densitiesOfRay(setting.march), rays);
  }

  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    Picture picture = evenPicture(request, {"R", "G", "B", "A"});
    Normal normal(request.samples);
    for (size_t i = 0; i < picture.planes[0].size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        picture.planes[c][i] = static_cast<float>(
            kRadiance * (1.0 + bias(view.scene.march) + noise(request.samples) * normal()));
    Setting setting;
    setting.march = view.scene.march;
    setting.samples = request.samples;
    cost.densitySamplesPerPixel = request.samples * densitiesOfRay(setting.march);
    cost.milliseconds = cost.millisecondsPreparing = 1.0;
    cost.milliseconds += kMillisecondsOfWork * work(setting, static_cast<double>(picture.planes[0].size())) *
                         std::pow(clock, 2.0 * double{clockRandom_.uniform()} - 1.0);
    return picture;
  }

  double clock = 1.0;

 private:
  truth::Random clockRandom_{3};
};

/// Truth in two noisy halves; costs what its noise says, by a clock that is off as the march's is.
class KnownTruth : public Method {
 public:
  explicit KnownTruth(double millisecondsForOnePercent) : atOnePercent_(millisecondsForOnePercent) {}
  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene&, const PictureRequest& request, PictureCost& cost) override {
    Picture picture = evenPicture(
        request, {"R", "G", "B", "A", "half1.R", "half1.G", "half1.B", "half2.R", "half2.G", "half2.B"});
    Normal normal(request.seed);
    const double half = std::sqrt(2.0) * request.error;
    for (size_t i = 0; i < picture.planes[0].size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        const double a = kRadiance * (1.0 + half * normal()), b = kRadiance * (1.0 + half * normal());
        picture.planes[4 + c][i] = static_cast<float>(a);
        picture.planes[7 + c][i] = static_cast<float>(b);
        picture.planes[c][i] = static_cast<float>(0.5 * (a + b));
      }
    const double share =
        static_cast<double>(picture.planes[0].size()) / (double{1.0} * request.width * request.height);
    cost.relativeError = request.error;
    cost.milliseconds = share * std::max(least, atOnePercent_ * 1e-4 / (request.error * request.error));
    cost.densitySamplesPerPixel = cost.milliseconds / kMillisecondsOfWork / workOfTruth(1.0, 0.0) /
                                  static_cast<double>(picture.planes[0].size());
    cost.milliseconds *= std::pow(clock, 2.0 * double{clockRandom_.uniform()} - 1.0);
    return picture;
  }

  double least = 0.0;  // milliseconds that any picture of this size takes
  double clock = 1.0;

 private:
  truth::Random clockRandom_{4};
  double atOnePercent_;
};

struct Search {
  explicit Search(double truthMilliseconds, int width = 480, int height = 270) : truth(truthMilliseconds) {
    request.width = width;
    request.height = height;
  }
  ErrorPick pick(double error) {
    ErrorSearch search(march, truth, view, request);
    return search.pick(error);
  }
  KnownMarch march;
  KnownTruth truth;
  ViewedScene view;
  PictureRequest request;
};

double trueError(const Setting& setting) {
  return std::hypot(KnownMarch::bias(setting.march), KnownMarch::noise(setting.samples));
}

TEST(ErrorRequest, KeepsItsWordAndALooserOneIsNeverDearer) {
  // Whatever the clock says: another search for each, as another run of the program would make it.
  Search search(1e9);
  search.march.clock = 4.0;
  double before = 0.0;
  for (double error = 0.2; error > 0.008; error *= 0.9) {
    const ErrorPick pick = search.pick(error);
    ASSERT_EQ(pick.setting.method, "march") << error;
    EXPECT_LE(trueError(pick.setting), error);
    EXPECT_GE(pick.work, before) << error;
    before = pick.work;
  }
}

TEST(ErrorRequest, ALooserOneIsNeverDearerThanTheReferenceWhateverTheClockSays) {
  Search search(1e4);
  search.march.clock = search.truth.clock = 8.0;
  double before = 0.0;
  bool marched = false, traced = false;
  for (double error = 0.2; error > 0.005; error *= 0.65) {
    const ErrorPick pick = search.pick(error);
    (pick.setting.method == "march" ? marched : traced) = true;
    EXPECT_GE(pick.work, before) << error;
    before = pick.work;
  }
  EXPECT_TRUE(marched);
  EXPECT_TRUE(traced);
}

TEST(ErrorRequest, AGraphicsProcessorsWorkCountsForLess) {
  Search search(100.0);
  EXPECT_EQ(search.pick(0.03).setting.method, "reference");
  search.march.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  EXPECT_EQ(search.pick(0.03).setting.method, "reference");
  search.march.renderer = "NVIDIA H100";
  EXPECT_EQ(search.pick(0.03).setting.method, "march");
}

TEST(ErrorRequest, WhatPassesForATightErrorPassesForALooserOne) {
  size_t step = TruthLadder::stepFor(0.3);
  EXPECT_EQ(step, 0u);
  for (double error = 0.3; error > 0.001; error *= 0.95) {
    const size_t next = TruthLadder::stepFor(error);
    EXPECT_GE(next, step);
    step = next;
    EXPECT_DOUBLE_EQ(TruthLadder::allowed(error, step), error);
    for (size_t other = 0; other <= step; ++other)
      EXPECT_LE(TruthLadder::allowed(error, other), TruthLadder::allowed(1.1 * error, other));
  }
}

TEST(ErrorRequest, PicksTheCheapestThatReaches) {
  constexpr double kError = 0.05;
  Search search(1e9);
  const double picked = search.pick(kError).work;
  constexpr double kSure = 0.97;  // what is nearer to the bound may count as over it
  const double pixels = double{1.0} * search.request.width * search.request.height;
  for (const MarchCandidate& candidate : marchCandidates(search.view.scene)) {
    Setting setting = candidate.setting;
    for (setting.samples = candidate.least; setting.samples <= candidate.most; setting.samples *= 2) {
      if (trueError(setting) >= kSure * kError) continue;
      EXPECT_LE(picked, 1.001 * KnownMarch::work(setting, pixels)) << nameOf(setting);
    }
  }
}

TEST(ErrorRequest, TheNextPickTakesMoreWork) {
  Search search(1e9);
  ErrorSearch picking(search.march, search.truth, search.view, search.request);
  const ErrorPick first = picking.pick(0.03), second = picking.pick(0.03, first.rung + 1);
  ASSERT_EQ(second.setting.method, "march");
  EXPECT_GT(second.work, first.work);
  EXPECT_LE(trueError(second.setting), 0.03);
}

TEST(ErrorRequest, TheReferenceIsPickedWhereNoMarchGetsThereOrItIsCheaper) {
  const ErrorPick fine = Search(1e9).pick(0.0005);  // the least bias is 0.001
  EXPECT_EQ(fine.setting.method, "reference");
  EXPECT_NEAR(fine.milliseconds, 1e9 * 1e-4 / (0.0005 * 0.0005), 1e-6 * fine.milliseconds);
  EXPECT_EQ(Search(1.0).pick(0.03).setting.method, "reference");
}

TEST(ErrorRequest, TheReferenceIsNoCheaperThanItsLeast) {
  Search search(1.0);
  search.truth.least = 1e6;
  EXPECT_EQ(search.pick(0.1).setting.method, "march");
}

TEST(ErrorRequest, MeasuresAWholePictureOnItsSparseGrid) {
  Search search(1e6);
  ErrorSearch measuring(search.march, search.truth, search.view, search.request);
  EXPECT_GT(measuring.stride(), 1);
  PictureRequest whole = search.request;
  whole.samples = 4;
  PictureCost cost;
  const Picture picture = search.march.render(search.view, whole, cost);
  const double expected = std::hypot(KnownMarch::bias(search.view.scene.march), KnownMarch::noise(4));
  const NoisyError error = measuring.measure(picture, 0.02).error;
  EXPECT_NEAR(error.relativeRmse, expected, 0.05 * expected);
  EXPECT_LT(error.low, expected);
  EXPECT_GT(error.high, expected);
  EXPECT_TRUE(measuring.measure(picture, 1.1 * expected).kept);
  EXPECT_FALSE(measuring.measure(picture, 0.9 * expected).kept);
}

TEST(ErrorRequest, WhatHasNoTruthIsRefused) {
  ViewedScene view;
  EXPECT_NO_THROW(requireTruth(view));
  view.scene.look = Look::report;
  EXPECT_THROW(requireTruth(view), InputError);
}

TEST(ErrorRequest, TruthHasTheOrdersThatTheSceneAsksFor) {
  ViewedScene view;
  EXPECT_EQ(bouncesOfTruth(view, {}), 0);
  EXPECT_EQ(bouncesOfTruth(view, 3), 3);
  view.scene.octaves.count = 2;
  EXPECT_EQ(bouncesOfTruth(view, {}), std::nullopt);
}

}  // namespace
}  // namespace nephele
