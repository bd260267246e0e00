// Which pixels the path tracer gives its samples to where it is asked for an error: the noisier ones, and no
// mean errs by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "preview/truth/estimate.h"
#include "tests/preview/truth_bench.h"

namespace nephele {
namespace {

using namespace testing_truth;

/// A pixel's blocks are 1 − noise and 1 + noise in turn.
void addNoisyPixel(truth::Estimate& estimate, size_t pixel, double noise) {
  constexpr unsigned kBlocks = 8;
  for (unsigned block = 0; block < kBlocks; ++block) {
    truth::BlockMean mean;
    for (int c = 0; c < 3; ++c) {
      mean.radiance[c] = static_cast<float>(block % 2 == 0 ? 1.0 - noise : 1.0 + noise);
      mean.transmittance[c] = 0.0f;
    }
    estimate.add(pixel, mean);
  }
}

TEST(TruthShares, SamplesGoWhereNeighboursAreNoisy) {
  constexpr int kSize = 5;
  constexpr size_t kNoisy = 12;  // the middle
  constexpr float kLeast = 0.2f;
  truth::Estimate estimate(kSize, kSize);
  for (size_t pixel = 0; pixel < size_t{kSize} * kSize; ++pixel)
    addNoisyPixel(estimate, pixel, pixel == kNoisy ? 0.5 : 0.0);
  const std::vector<float> shares = estimate.shares(kLeast);
  double sum = 0.0;
  for (size_t pixel = 0; pixel < shares.size(); ++pixel) {
    sum += double{shares[pixel]};
    const int dx = std::abs(static_cast<int>(pixel % kSize) - 2),
              dy = std::abs(static_cast<int>(pixel / kSize) - 2);
    // Eight neighbours share alike what is not given to all; the pixel itself has no say in how much it gets.
    const bool beside = std::max(dx, dy) == 1;
    EXPECT_NEAR(shares[pixel], beside ? kLeast + (1.0f - kLeast) * kSize * kSize / 8.0f : kLeast, 1e-5f)
        << pixel;
  }
  EXPECT_NEAR(sum, kSize * kSize, 1e-4);
}

TEST(TruthShares, EvenNoiseIsSampledEvenly) {
  truth::Estimate estimate(4, 4);
  for (size_t pixel = 0; pixel < 16; ++pixel) addNoisyPixel(estimate, pixel, 0.3);
  for (const float share : estimate.shares(0.2f)) EXPECT_NEAR(share, 1.0f, 1e-5f);
  truth::Estimate quiet(4, 4);
  for (size_t pixel = 0; pixel < 16; ++pixel) addNoisyPixel(quiet, pixel, 0.0);
  for (const float share : quiet.shares(0.2f)) EXPECT_EQ(share, 1.0f);
}

/// Looks towards a low sun: noise is by far the largest around it.
ViewedScene viewTowardsTheSun() {
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.9, mediumOf(6.0, 0.5, 0.9));
  view.scene.lights = {sunFrom({0.1, 1, 0.1}, 3.0)};
  return view;
}

TEST(TruthShares, UnevenNoiseTakesFewerPathsThanEvenSamplesWould) {
  const BrickVolume bricks = smallCloud();
  const ViewedScene view = viewTowardsTheSun();
  const auto method = makeReferenceMethod({});
  method->setVolume(bricks);
  PictureRequest request = requestOf(16, 256, 0);
  PictureCost even, uneven;
  method->render(view, request, even);
  request.error = 0.02;
  method->render(view, request, uneven);
  const double asGood = even.pathsPerPixel * std::pow(even.relativeError / uneven.relativeError, 2);
  EXPECT_LT(uneven.pathsPerPixel, 0.7 * asGood) << even.relativeError << ' ' << uneven.relativeError;
}

TEST(TruthShares, UnevenSamplesStayRightOnTheMean) {
  constexpr unsigned kPictures = 60;
  const BrickVolume bricks = smallCloud();
  const ViewedScene view = viewTowardsTheSun();
  const auto method = makeReferenceMethod({});
  method->setVolume(bricks);
  PictureCost cost;
  PictureRequest request = requestOf(8, 1 << 13, 0);
  const double expected = meanOf(plane(method->render(view, request, cost), "R"));
  request.error = 0.1;
  double sum = 0.0, squares = 0.0;
  for (unsigned i = 0; i < kPictures; ++i) {
    request.seed = 1 + i;
    const double mean = meanOf(plane(method->render(view, request, cost), "R")) / expected;
    sum += mean / kPictures;
    squares += mean * mean / kPictures;
  }
  const double deviation = std::sqrt((squares - sum * sum) / kPictures);
  constexpr double kLevel = 4.0;  // standard deviations: once in 16000 seeds
  EXPECT_NEAR(sum, 1.0, kLevel * deviation);
  EXPECT_LT(deviation, 0.0025);  // so that a percent would be seen
}

}  // namespace
}  // namespace nephele
