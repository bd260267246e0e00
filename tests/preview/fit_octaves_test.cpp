// Factors of octaves: the least point of a known function, factors recovered from a known picture, and what a
// scene takes from a file.
#include "preview/measure/fit_octaves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "preview/measure/least_point.h"
#include "preview/resolve.h"
#include "preview/truth/random.h"

namespace nephele {
namespace {

TEST(FitOctaves, FindsTheLeastPointOfAKnownFunction) {
  for (const OctaveFactors least : {OctaveFactors{0.3, 0.6, 0.2, 0.7}, OctaveFactors{1.0, 0.0, 0.5, 1.0}}) {
    const auto cost = [&](const OctaveFactors& at) {
      double sum = 0.0;
      for (size_t i = 0; i < at.size(); ++i) {
        EXPECT_GE(at[i], 0.0);
        EXPECT_LE(at[i], 1.0);
        sum += (1.0 + static_cast<double>(i)) * (at[i] - least[i]) * (at[i] - least[i]);
      }
      return sum;
    };
    const OctaveFactors found = leastOf(cost, kUnfittedFactors, 1e-4, 400);
    for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], least[i], 0.02) << i;
  }
}

TEST(FitOctaves, ALatticeFindsTheDeeperOfTwoValleys) {
  const auto cost = [](const UnitPoint& at) {
    const auto valley = [&](double place, double depth) {
      double squares = 0.0;
      for (const double x : at) squares += (x - place) * (x - place);
      return -depth * std::exp(-20.0 * squares);
    };
    return valley(0.4, 1.0) + valley(0.9, 1.5);
  };
  EXPECT_NEAR(leastOf(cost, kUnfittedFactors, 1e-4, 400)[0], 0.4, 0.02);
  for (const double found : leastOfCube(cost, 6, 1e-4, 400)) EXPECT_NEAR(found, 0.9, 0.02);
}

TEST(FitOctaves, StopsAfterTheMostTries) {
  size_t tries = 0;
  leastOf([&](const OctaveFactors& at) { return ++tries * 1e-9 + at[0]; }, kUnfittedFactors, 1e-12, 20);
  EXPECT_LE(tries, 24u);  // a shrinking step may end beyond by its corners
}

/// Orders with the factors' roles: light through columns of i, phases and openness of the place.
double radianceAt(const Octaves& octaves, size_t pixel, double azimuth) {
  double sum = 0.0, a = 1.0, b = 1.0, c = 1.0;
  const double column = 0.2 + 0.01 * static_cast<double>(pixel % 97),
               turn = std::sin(0.07 * static_cast<double>(pixel) + azimuth),
               openness = 0.05 + 0.009 * static_cast<double>(pixel % 89);
  for (int m = 0; m <= *octaves.count; ++m) {
    sum += b * std::exp(-3.0 * a * column) * (1.0 + 0.8 * c * turn);
    a *= octaves.a;
    b *= octaves.b * (1.0 - octaves.d * openness);
    c *= octaves.c;
  }
  return sum;
}

constexpr Octaves kTrue{6, 0.7, 0.5, 0.4, 0.6, true};
FitOptions quickly() {
  FitOptions options;
  options.width = 24;
  options.height = 18;
  options.quiet = true;
  return options;
}

constexpr double kMiddleSun = kFittedElevations[1];

class KnownOctaves : public Method {
 public:
  explicit KnownOctaves(bool isTruth) : isTruth_(isTruth) {}
  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost&) override {
    Picture picture;
    picture.width = request.width;
    picture.height = request.height;
    for (const char* name : {"R", "G", "B", "A"}) picture.add(name);
    for (const char* half : {"half1.", "half2."})
      for (const char* name : {"R", "G", "B"}) picture.add(std::string(half) + name);
    picture.planes[3].assign(picture.planes[3].size(), 1.0f);
    truth::Random random(request.seed + 1);
    for (size_t i = 0; i < picture.planes[0].size(); ++i) {
      const double radiance = radianceAt(isTruth_ ? octaves_ : view.scene.octaves, i, view.camera.position.x);
      for (size_t c = 0; c < 3; ++c) {
        picture.planes[c][i] = static_cast<float>(radiance);
        for (const size_t half : {size_t{4}, size_t{7}})
          picture.planes[half + c][i] =
              static_cast<float>(radiance * (1.0 + 0.2 * (double{random.uniform()} - 0.5)));
      }
    }
    return picture;
  }

 protected:
  Octaves octaves_ = kTrue;  // truth's

 private:
  bool isTruth_;
};

TEST(FitOctaves, ASquareOfErrorsIsThatOfThePictureItself) {
  KnownOctaves march(false), truth(true);
  PictureRequest request;
  request.width = request.height = 24;
  const ViewedScene view;
  PictureCost cost;
  const Picture reference = truth.render(view, request, cost);
  constexpr double kApart =
      4e-3;  // twice what interpolation adds to radiance, 0.2% of truth or of the picture
  OctaveForm form = OctaveForm::of(march, view, request, reference);
  for (const int count : {1, 6, 16})
    for (const OctaveFactors factors :
         {kUnfittedFactors, OctaveFactors{0.7, 0.35, 0.9, 0.3}, OctaveFactors{0.0, 1.0, 0.0, 1.0},
          OctaveFactors{1.0, 0.2, 1.0, 0.6}}) {
      ViewedScene drawn;
      drawn.scene.octaves = {count, factors[0], factors[1], factors[2], factors[3], true};
      const double error = compareWithHalves(march.render(drawn, request, cost), reference).relativeRmse;
      EXPECT_NEAR(form.at(factors, count), error * error, kApart * error * std::max(1.0, error) + 1e-5)
          << count << ' ' << factors[0];
    }
  const double one = form.at(kUnfittedFactors, 6);
  form.add(form);
  EXPECT_NEAR(form.at(kUnfittedFactors, 6), 2.0 * one, 1e-9 * one);
}

TEST(FitOctaves, WithoutACountTakesTheFewestThatDoNearlyAsWell) {
  KnownOctaves march(false), truth(true);
  const BrickVolume bricks;
  FitOptions options = quickly();
  const FitResult free = fitOctaves(march, truth, {{"known", &bricks, ViewedScene{}}}, {}, options);
  EXPECT_GE(free.count, 2);
  EXPECT_LE(free.count, *kTrue.count);
  EXPECT_LT(errorOver(free.views, false, FitStage::after), 0.02);
}

TEST(FitOctaves, RecoversKnownFactorsThroughNoiseAndHalvesTheErrorOfTheUnfitted) {
  KnownOctaves march(false), truth(true);
  const BrickVolume bricks;
  FitOptions options = quickly();
  options.count = kTrue.count;
  const FitResult result = fitOctaves(march, truth, {{"known", &bricks, ViewedScene{}}}, {}, options);
  for (const OctaveFactors& factors : result.factors) {
    EXPECT_NEAR(factors[0], kTrue.a, 0.05);
    EXPECT_NEAR(factors[1], kTrue.b, 0.05);
    EXPECT_NEAR(factors[2], kTrue.c, 0.1);
    EXPECT_NEAR(factors[3], kTrue.d, 0.1);
  }
  size_t held = 0;
  for (const FitView& view : result.views) held += view.fitted ? 0 : 1;
  EXPECT_EQ(held, 8u);
  for (const bool fitted : {true, false})
    EXPECT_LT(errorOver(result.views, fitted, FitStage::after),
              0.5 * errorOver(result.views, fitted, FitStage::before));
}

/// Truth whose factors follow the sun's height: what no one set can be.
class FollowsTheSun : public KnownOctaves {
 public:
  explicit FollowsTheSun(bool isTruth) : KnownOctaves(isTruth) {}
  static OctaveFactors factorsOf(double elevation) { return factorsAt(kFactors, elevation); }
  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    const OctaveFactors f = factorsOf(sunElevation(view.scene, view.up));
    octaves_ = {kTrue.count, f[0], f[1], f[2], f[3], true};
    return KnownOctaves::render(view, request, cost);
  }
  static constexpr SunFactors kFactors{{{0.3, 0.5, 0.4, 0.2}, {0.6, 0.4, 0.4, 0.4}, {0.8, 0.7, 0.4, 0.5}}};
};

TEST(FitOctaves, FactorsFollowTheSunsHeight) {
  KnownOctaves march(false);
  FollowsTheSun truth(true);
  const BrickVolume bricks;
  FitOptions options = quickly();
  options.count = kTrue.count;
  const FitResult result = fitOctaves(march, truth, {{"known", &bricks, ViewedScene{}}}, {}, options);
  for (size_t node = 0; node < result.factors.size(); ++node)
    for (size_t i = 0; i < FollowsTheSun::kFactors[node].size(); ++i)
      EXPECT_NEAR(result.factors[node][i], FollowsTheSun::kFactors[node][i], 0.12) << node << ' ' << i;
  EXPECT_LT(errorOver(result.views, false, FitStage::after), 0.1);
  EXPECT_LT(errorOver(result.views, false, FitStage::atBest), 0.02);
}

TEST(FitOctaves, FactorsAreLinearBetweenHeightsOfTheSunAndHoldBeyond) {
  constexpr SunFactors kFactors{{{0.0, 0.2, 1.0, 0.0}, {0.5, 0.4, 0.0, 0.8}, {1.0, 0.4, 0.5, 1.0}}};
  const auto [low, middle, high] = kFittedElevations;
  EXPECT_EQ(factorsAt(kFactors, low), kFactors[0]);
  EXPECT_EQ(factorsAt(kFactors, middle), kFactors[1]);
  EXPECT_EQ(factorsAt(kFactors, -high), kFactors[2]);  // from below as from above
  EXPECT_EQ(factorsAt(kFactors, 0.0), kFactors[0]);
  EXPECT_EQ(factorsAt(kFactors, 90.0), kFactors[2]);
  EXPECT_DOUBLE_EQ(factorsAt(kFactors, 0.75 * low + 0.25 * middle)[0], 0.125);
  EXPECT_DOUBLE_EQ(factorsAt(kFactors, 0.5 * (middle + high))[2], 0.25);
}

TEST(FitOctaves, TheBrightestSunIsTheOneThatFactorsFollow) {
  const glm::dvec3 up{0.0, 1.0, 0.0};
  Scene scene;
  scene.lights = {};
  EXPECT_EQ(sunElevation(scene, up), kFittedElevations[1]);
  scene.lights = {PointLight{}, Sun{{0.0, 3.0, 4.0}, {1.0, 1.0, 1.0}}, Sun{{1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}}};
  EXPECT_NEAR(sunElevation(scene, up), 180.0 / 3.141592653589793 * std::asin(0.6), 1e-9);
}

TEST(FitOctaves, SaysWhereViewsHeldBackGetWorse) {
  std::vector<FitView> views(2);
  views[1].fitted = false;
  views[0].before.relativeRmse = 0.6;  // views fitted to do not count
  views[0].after.relativeRmse = 0.1;
  views[1].before.relativeRmse = 0.5;
  views[1].after.relativeRmse = 0.7;
  EXPECT_TRUE(worsensHeldBack(views));
  views[1].after.relativeRmse = 0.4;
  views[0].after.relativeRmse = 0.9;
  EXPECT_FALSE(worsensHeldBack(views));
}

TEST(FitOctaves, ASceneTakesTheFilesFactorsWhereItGivesNone) {
  BrickVolume bricks;
  Octaves octaves;
  EXPECT_FALSE(takeFittedFactors(octaves, bricks, kMiddleSun));
  bricks.metadata = {{"octaves_a", "0.25"}, {"octaves_b", "0.75"}, {"octaves_c", "1"}};
  EXPECT_TRUE(takeFittedFactors(octaves, bricks, kMiddleSun));
  EXPECT_EQ(octaves.a, 0.25);
  EXPECT_EQ(octaves.b, 0.75);
  EXPECT_EQ(octaves.c, 1.0);
  EXPECT_FALSE(octaves.count);
  EXPECT_EQ(octaves.d, 0.0);
  Octaves given{3, 0.1, 0.2, 0.3, 0.4, true};
  EXPECT_FALSE(takeFittedFactors(given, bricks, kMiddleSun));
  EXPECT_EQ(given.a, 0.1);
  bricks.metadata["octaves_a"] = "[0.25, 0.5, 1]";
  EXPECT_TRUE(takeFittedFactors(octaves, bricks, kFittedElevations[2]));
  EXPECT_EQ(octaves.a, 1.0);
  EXPECT_EQ(octaves.b, 0.75);
  bricks.metadata["octaves_d"] = "[1, 0.5, 0.25]";
  EXPECT_TRUE(takeFittedFactors(octaves, bricks, kFittedElevations[2]));
  EXPECT_EQ(octaves.d, 0.25);
  bricks.metadata["octaves_count"] = "9";
  EXPECT_TRUE(takeFittedFactors(octaves, bricks, kMiddleSun));
  EXPECT_EQ(octaves.count, 9);
  Octaves counted{3, 0.5, 0.5, 0.5, 0.0, false};
  EXPECT_TRUE(takeFittedFactors(counted, bricks, kMiddleSun));
  EXPECT_EQ(counted.count, 3);
  for (const char* wrong : {"17", "2.5", "-1", "many"}) {
    bricks.metadata["octaves_count"] = wrong;
    Octaves open;
    EXPECT_THROW(takeFittedFactors(open, bricks, kMiddleSun), InputError) << wrong;
  }
  bricks.metadata.erase("octaves_count");
  bricks.metadata["octaves_b"] = "1.5";
  EXPECT_THROW(takeFittedFactors(octaves, bricks, kMiddleSun), InputError);
}

}  // namespace
}  // namespace nephele
