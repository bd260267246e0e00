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

/// Errs by a bias that grows with steps and the cache's cells, and by noise that falls with samples.
class KnownMarch : public Method {
 public:
  static double bias(const MarchSettings& march) {
    return 0.004 * march.stepVoxels + (march.lightCache ? 0.006 * march.cacheVoxels : 0.0);
  }
  static double noise(unsigned samples) { return 0.08 / std::sqrt(static_cast<double>(samples)); }
  static double milliseconds(const MarchSettings& march, unsigned samples) {
    return 20.0 * samples / march.stepVoxels * (march.lightCache ? 1.0 : 5.0);
  }

  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    Picture picture = evenPicture(request, {"R", "G", "B", "A"});
    Normal normal(request.samples);
    for (size_t i = 0; i < picture.planes[0].size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        picture.planes[c][i] = static_cast<float>(
            kRadiance * (1.0 + bias(view.scene.march) + noise(request.samples) * normal()));
    const double share =
        static_cast<double>(picture.planes[0].size()) / (double{1.0} * request.width * request.height);
    cost.milliseconds = cost.millisecondsPreparing = 1.0;
    cost.milliseconds += share * milliseconds(view.scene.march, request.samples);
    return picture;
  }
};

/// Truth in two noisy halves; costs what its noise says.
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
    cost.milliseconds = share * atOnePercent_ * 1e-4 / (request.error * request.error);
    return picture;
  }

 private:
  double atOnePercent_;
};

struct Search {
  explicit Search(double truthMilliseconds, int width = 480, int height = 270) : truth(truthMilliseconds) {
    request.width = width;
    request.height = height;
  }
  ErrorPick pick(double error) {
    ErrorSearch search(march, truth, view, request, error);
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
  Search search(1e9);
  double before = 0.0;
  for (const double error : {0.2, 0.1, 0.05, 0.03, 0.02}) {
    const ErrorPick pick = search.pick(error);
    ASSERT_EQ(pick.setting.method, "march") << error;
    EXPECT_LE(trueError(pick.setting), error);
    EXPECT_GE(pick.milliseconds, before) << error;
    before = pick.milliseconds;
  }
}

TEST(ErrorRequest, PicksTheCheapestThatReaches) {
  constexpr double kError = 0.05;
  Search search(1e9);
  const double picked = search.pick(kError).milliseconds;
  constexpr double kSure = 0.97;  // what is nearer to the bound may count as over it
  for (const Setting& candidate : marchCandidates(search.view.scene)) {
    for (Setting setting = candidate; setting.samples <= 64; setting.samples *= 2) {
      if (trueError(setting) >= kSure * kError) continue;
      const double milliseconds = KnownMarch::milliseconds(setting.march, setting.samples);
      EXPECT_LE(picked, 1.05 * milliseconds + 1.0) << nameOf(setting);
    }
  }
}

TEST(ErrorRequest, TheReferenceIsPickedWhereNoMarchGetsThereOrItIsCheaper) {
  const ErrorPick fine = Search(1e9).pick(0.0005);  // the least bias is 0.001
  EXPECT_EQ(fine.setting.method, "reference");
  EXPECT_NEAR(fine.milliseconds, 1e9 * 1e-4 / (0.0005 * 0.0005), 1e-6 * fine.milliseconds);
  EXPECT_EQ(Search(1.0).pick(0.03).setting.method, "reference");
}

TEST(ErrorRequest, MeasuresAWholePictureOnItsSparseGrid) {
  Search search(1e6);
  ErrorSearch measuring(search.march, search.truth, search.view, search.request, 0.02);
  EXPECT_GT(measuring.stride(), 1);
  PictureRequest whole = search.request;
  whole.samples = 4;
  PictureCost cost;
  const Picture picture = search.march.render(search.view, whole, cost);
  const NoisyError error = measuring.measure(picture);
  const double expected = std::hypot(KnownMarch::bias(search.view.scene.march), KnownMarch::noise(4));
  EXPECT_NEAR(error.relativeRmse, expected, 0.05 * expected);
  EXPECT_LT(error.low, expected);
  EXPECT_GT(error.high, expected);
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
