// Phase functions and the step integral against closed forms in higher precision.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shaders/shared/leaves.h"

namespace nephele::shared {
namespace {

constexpr double kPiDouble = std::numbers::pi;

vec3 directionAt(double theta) {
  return vec3(static_cast<float>(std::sin(theta)), 0.0f, static_cast<float>(std::cos(theta)));
}

/// ∫ phase · weight(cosθ) over the sphere, with nodes crowded towards both poles, where the lobes are.
template <class Weight>
double overSphere(float g, Weight weight) {
  constexpr int kNodes = 4000;
  const vec3 ray(0.0f, 0.0f, 1.0f);
  double sum = 0.0;
  for (int half = 0; half < 2; ++half) {
    double previous = 0.0;
    for (int k = 1; k <= kNodes; ++k) {
      const double edge = 0.5 * kPiDouble * std::pow(static_cast<double>(k) / kNodes, 4.0);
      for (double node : {-1.0, 1.0}) {  // Gauss of order 2
        const double polar = 0.5 * (previous + edge) + node * 0.5 * (edge - previous) / std::sqrt(3.0);
        const double theta = half == 0 ? polar : kPiDouble - polar;
        sum += 0.5 * (edge - previous) * 2.0 * kPiDouble * std::sin(theta) * weight(std::cos(theta)) *
               double{phaseHenyeyGreenstein(directionAt(theta), ray, g)};
      }
      previous = edge;
    }
  }
  return sum;
}

TEST(HenyeyGreenstein, IntegratesToOneWithMeanCosineG) {
  for (float g : {-0.999f, -0.9f, -0.3f, 0.0f, 0.3f, 0.6f, 0.9f, 0.999f}) {
    // Float vectors near a pole carry angles to 6e-8 of a radian, and the lobe at |g| = 0.999 is 1e-3 wide.
    constexpr double kTolerance = 2e-5;
    EXPECT_NEAR(overSphere(g, [](double) { return 1.0; }), 1.0, kTolerance) << "g = " << g;
    EXPECT_NEAR(overSphere(g, [](double cosTheta) { return cosTheta; }), double{g}, kTolerance)
        << "g = " << g;
  }
}

TEST(HenyeyGreenstein, AgreesWithTheTextbookInLongDouble) {
  const vec3 ray(0.0f, 0.0f, 1.0f);
  for (float g : {-0.999f, -0.6f, 0.0f, 0.6f, 0.999f}) {
    for (double theta : {0.0, 1e-4, 1e-3, 0.01, 0.1, 1.0, 2.0, 3.0, 3.14, kPiDouble}) {
      const long double bigG = static_cast<long double>(g);
      const long double cosTheta = std::cos(static_cast<long double>(theta));
      const long double base = 1.0L + bigG * bigG - 2.0L * bigG * cosTheta;
      const long double expected =
          (1.0L - bigG * bigG) / (4.0L * std::numbers::pi_v<long double> * base * std::sqrt(base));
      const double actual = double{phaseHenyeyGreenstein(directionAt(theta), ray, g)};
      EXPECT_NEAR(actual / static_cast<double>(expected), 1.0, 1e-5) << "g = " << g << ", theta = " << theta;
    }
  }
}

TEST(Directions, LookingAtTheLightIsForward) {
  const vec3 ray(0.0f, 0.6f, 0.8f);
  const double g = 0.6;
  const double forward = (1.0 - g * g) / (4.0 * kPiDouble * std::pow(1.0 - g, 3.0));
  const double backward = (1.0 - g * g) / (4.0 * kPiDouble * std::pow(1.0 + g, 3.0));
  EXPECT_NEAR(double{phaseHenyeyGreenstein(ray, ray, 0.6f)} / forward, 1.0, 1e-5);
  EXPECT_NEAR(double{phaseHenyeyGreenstein(-ray, ray, 0.6f)} / backward, 1.0, 1e-5);
  EXPECT_NEAR(double{phaseIsotropic()}, 1.0 / (4.0 * kPiDouble), 1e-8);
}

TEST(HenyeyGreenstein, SamplesFollowTheDensity) {
  // The mean cosine of samples is g; with stratified u1 the error is that of the midpoint rule.
  constexpr int kSamples = 20000;
  const vec3 ray = normalize(vec3(0.3f, -0.5f, 0.8f));
  for (float g : {-0.8f, 0.0f, 0.5f, 0.9f}) {
    double mean = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const float u1 = (static_cast<float>(i) + 0.5f) / static_cast<float>(kSamples);
      const vec3 direction = sampleHenyeyGreenstein(ray, g, u1, 0.37f);
      EXPECT_NEAR(double{length(direction)}, 1.0, 1e-5);
      mean += double{dot(direction, ray)} / kSamples;
    }
    EXPECT_NEAR(mean, double{g}, 1e-4);
  }
}

TEST(StepIntegral, AgreesWithExpm1InLongDouble) {
  double worst = 0.0, worstAt = 0.0;
  for (double exponent = -8.0; exponent <= 3.0; exponent += 1e-4) {
    const float x = static_cast<float>(std::pow(10.0, exponent));
    const long double big = static_cast<long double>(x);
    const double expected = static_cast<double>(-std::expm1(-big) / big);
    const double error = std::abs(double{stepIntegral(x)} / expected - 1.0);
    if (error > worst) {
      worst = error;
      worstAt = double{x};
    }
  }
  std::printf("step integral: largest relative error %.3g at x = %.4g\n", worst, worstAt);
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(stepIntegral(0.0f), 1.0f);
}

}  // namespace
}  // namespace nephele::shared
