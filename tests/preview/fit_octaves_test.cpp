// Factors of octaves: the least point of a known function, factors recovered from a known picture, and what a
// scene takes from a file.
#include "preview/measure/fit_octaves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "preview/resolve.h"
#include "preview/truth/random.h"

namespace nephele {
namespace {

TEST(FitOctaves, FindsTheLeastPointOfAKnownFunction) {
  for (const OctaveFactors least : {OctaveFactors{0.3, 0.6, 0.2}, OctaveFactors{1.0, 0.0, 0.5}}) {
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

TEST(FitOctaves, StopsAfterTheMostTries) {
  size_t tries = 0;
  leastOf([&](const OctaveFactors& at) { return ++tries * 1e-9 + at[0]; }, kUnfittedFactors, 1e-12, 20);
  EXPECT_LE(tries, 24u);  // a shrinking step may end beyond by its corners
}

/// Orders with the factors' roles: light through columns of i, phases of the place.
double radianceAt(const Octaves& octaves, size_t pixel, double azimuth) {
  double sum = 0.0, a = 1.0, b = 1.0, c = 1.0;
  const double column = 0.2 + 0.01 * static_cast<double>(pixel % 97),
               turn = std::sin(0.07 * static_cast<double>(pixel) + azimuth);
  for (int m = 0; m <= *octaves.count; ++m) {
    sum += b * std::exp(-3.0 * a * column) * (1.0 + 0.8 * c * turn);
    a *= octaves.a;
    b *= octaves.b;
    c *= octaves.c;
  }
  return sum;
}

constexpr Octaves kTrue{6, 0.7, 0.35, 0.4, true};

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
      const double radiance = radianceAt(isTruth_ ? kTrue : view.scene.octaves, i, view.camera.position.x);
      for (size_t c = 0; c < 3; ++c) {
        picture.planes[c][i] = static_cast<float>(radiance);
        for (const size_t half : {size_t{4}, size_t{7}})
          picture.planes[half + c][i] =
              static_cast<float>(radiance * (1.0 + 0.2 * (double{random.uniform()} - 0.5)));
      }
    }
    return picture;
  }

 private:
  bool isTruth_;
};

TEST(FitOctaves, RecoversKnownFactorsThroughNoiseAndHalvesTheErrorOfTheUnfitted) {
  KnownOctaves march(false), truth(true);
  const BrickVolume bricks;
  FitOptions options;
  options.quiet = true;
  const FitResult result = fitOctaves(march, truth, {{"known", &bricks, ViewedScene{}}}, {}, options);
  EXPECT_NEAR(result.factors[0], kTrue.a, 0.05);
  EXPECT_NEAR(result.factors[1], kTrue.b, 0.05);
  EXPECT_NEAR(result.factors[2], kTrue.c, 0.1);
  size_t held = 0;
  for (const FitView& view : result.views) held += view.fitted ? 0 : 1;
  EXPECT_EQ(held, 4u);
  for (const bool fitted : {true, false})
    EXPECT_LT(errorOver(result.views, fitted, true), 0.5 * errorOver(result.views, fitted, false));
}

TEST(FitOctaves, ASceneTakesTheFilesFactorsWhereItGivesNone) {
  BrickVolume bricks;
  Octaves octaves;
  EXPECT_FALSE(takeFittedFactors(octaves, bricks));
  bricks.metadata = {{"octaves_a", "0.25"}, {"octaves_b", "0.75"}, {"octaves_c", "1"}};
  EXPECT_TRUE(takeFittedFactors(octaves, bricks));
  EXPECT_EQ(octaves.a, 0.25);
  EXPECT_EQ(octaves.b, 0.75);
  EXPECT_EQ(octaves.c, 1.0);
  Octaves given{3, 0.1, 0.2, 0.3, true};
  EXPECT_FALSE(takeFittedFactors(given, bricks));
  EXPECT_EQ(given.a, 0.1);
  bricks.metadata["octaves_b"] = "1.5";
  EXPECT_THROW(takeFittedFactors(octaves, bricks), InputError);
}

}  // namespace
}  // namespace nephele
