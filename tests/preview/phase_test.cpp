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

TEST(PhaseFunction, TwoLobesIntegrateToOneWithTheMeanOfTheirCosines) {
  for (const vec3& lobes : {vec3(0.8f, -0.3f, 0.35f), vec3(0.95f, -0.6f, 0.5f), vec3(0.4f, 0.0f, 1.0f)}) {
    const double share = double{lobes.z};
    const auto sum = [&](auto weight) {
      return (1.0 - share) * overSphere(lobes.x, weight) + share * overSphere(lobes.y, weight);
    };
    EXPECT_NEAR(sum([](double) { return 1.0; }), 1.0, 2e-5);
    EXPECT_NEAR(sum([](double cosTheta) { return cosTheta; }), double{phaseMeanCosine(lobes)}, 2e-5);
    // The function is that mix at every angle.
    const vec3 ray(0.0f, 0.0f, 1.0f);
    for (double theta : {0.0, 0.3, 1.5, 2.9, kPiDouble}) {
      const vec3 d = directionAt(theta);
      const double expected = (1.0 - share) * double{phaseHenyeyGreenstein(d, ray, lobes.x)} +
                              share * double{phaseHenyeyGreenstein(d, ray, lobes.y)};
      EXPECT_NEAR(double{phaseFunction(d, ray, lobes)} / expected, 1.0, 1e-6);
    }
  }
}

TEST(PhaseFunction, WithoutASecondLobeIsHenyeyGreenstein) {
  const vec3 ray(0.0f, 0.0f, 1.0f);
  for (double theta : {0.0, 1.0, 3.0})
    EXPECT_EQ(phaseFunction(directionAt(theta), ray, vec3(0.7f, -0.9f, 0.0f)),
              phaseHenyeyGreenstein(directionAt(theta), ray, 0.7f));
}

TEST(PhaseFunction, SilverLiningPlusIsBrightTowardsTheLightAndAwayFromIt) {
  const vec3 ray(0.0f, 0.0f, 1.0f), lobes(0.8f, -0.3f, 0.35f);
  const auto closed = [](double g, double cosTheta) {
    return (1.0 - g * g) / (4.0 * kPiDouble * std::pow(1.0 + g * g - 2.0 * g * cosTheta, 1.5));
  };
  EXPECT_NEAR(double{phaseFunction(ray, ray, lobes)}, 0.65 * closed(0.8, 1.0) + 0.35 * closed(-0.3, 1.0),
              1e-4);
  EXPECT_NEAR(double{phaseFunction(-ray, ray, lobes)}, 0.65 * closed(0.8, -1.0) + 0.35 * closed(-0.3, -1.0),
              1e-6);
  EXPECT_GT(phaseFunction(-ray, ray, lobes), 2.0f * phaseFunction(-ray, ray, vec3(0.8f, 0.0f, 0.0f)));
}

TEST(PhaseFunction, SamplesFollowBothLobes) {
  constexpr int kSamples = 20000;
  const vec3 ray = normalize(vec3(0.3f, -0.5f, 0.8f));
  const vec3 lobes(0.8f, -0.5f, 0.4f);
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const float u1 = (static_cast<float>(i) + 0.5f) / static_cast<float>(kSamples);
    const double cosTheta = double{dot(samplePhaseFunction(ray, lobes, u1, 0.37f), ray)};
    mean += cosTheta / kSamples;
    square += cosTheta * cosTheta / kSamples;
  }
  EXPECT_NEAR(mean, double{phaseMeanCosine(lobes)}, 1e-4);
  // ∫ cos²θ of one lobe is (1 + 2 g²)/3.
  EXPECT_NEAR(square, 0.6 * (1.0 + 2.0 * 0.64) / 3.0 + 0.4 * (1.0 + 2.0 * 0.25) / 3.0, 1e-4);
}

TEST(Powder, HasTheValuesOfItsFormula) {
  const auto remap = [](double v, double l0, double h0, double ln, double hn) {
    const double held = std::min(std::max(v, std::min(l0, h0)), std::max(l0, h0));
    return ln + (held - l0) * (hn - ln) / (h0 - l0);
  };
  for (double strength : {0.3, 1.0, 5.0})
    for (double d : {1e-4, 0.1, 0.5, 1.0})
      for (double h : {-0.2, 0.0, 0.15, 0.3, 0.6, 0.9, 1.2}) {
        const double lost = std::min(strength * std::pow(d, remap(h, 0.3, 0.9, 0.5, 1.0)), 1.0);
        const double expected = 1.0 - lost * std::pow(remap(h, 0.0, 0.3, 0.8, 1.0), 0.8);
        const float actual =
            powderFactor(static_cast<float>(strength), static_cast<float>(d), static_cast<float>(h));
        EXPECT_NEAR(double{actual}, expected, 1e-6) << strength << ' ' << d << ' ' << h;
      }
  EXPECT_EQ(powderFactor(1.0f, 1.0f, 0.5f), 0.0f) << "the densest voxel of the middle loses all";
  EXPECT_NEAR(double{powderFactor(1.0f, 1.0f, 0.0f)}, 1.0 - std::pow(0.8, 0.8), 1e-6) << "less at the base";
  EXPECT_EQ(powderFactor(0.0f, 1.0f, 0.5f), 1.0f);
}

TEST(EllipsoidChord, IsTheSpheresAndTheEllipsoids) {
  const vec3 centre(10.0f, 20.0f, 30.0f), ball(5.0f);
  const float far = 3.0e38f;
  EXPECT_NEAR(double{ellipsoidChord(centre, vec3(1, 0, 0), centre, ball, far)}, 5.0, 1e-5);
  EXPECT_NEAR(double{ellipsoidChord(centre - vec3(0, 0, 3), vec3(0, 0, 1), centre, ball, far)}, 8.0, 1e-5);
  EXPECT_NEAR(double{ellipsoidChord(centre + vec3(0, 3, 0), vec3(1, 0, 0), centre, ball, far)}, 4.0, 1e-5);
  // From outside the whole chord, beside it nothing, behind it nothing; a light inside ends it.
  EXPECT_NEAR(double{ellipsoidChord(centre + vec3(9, 3, 0), vec3(-1, 0, 0), centre, ball, far)}, 8.0, 1e-5);
  EXPECT_EQ(ellipsoidChord(centre + vec3(0, 6, 0), vec3(1, 0, 0), centre, ball, far), 0.0f);
  EXPECT_EQ(ellipsoidChord(centre + vec3(9, 0, 0), vec3(1, 0, 0), centre, ball, far), 0.0f);
  EXPECT_NEAR(double{ellipsoidChord(centre, vec3(1, 0, 0), centre, ball, 2.0f)}, 2.0, 1e-6);
  // Axes of their own, and lengths in multiples of the direction.
  EXPECT_NEAR(double{ellipsoidChord(centre, vec3(0, 0, 2), centre, vec3(1, 2, 7), far)}, 3.5, 1e-5);
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
