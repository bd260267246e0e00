// The path tracer's parts against closed forms: phase function, stratified points, transmittance.
#include <gtest/gtest.h>

#include <glm/matrix.hpp>
#include <set>

#include "preview/truth/phase.h"
#include "preview/truth/tracking.h"
#include "tests/preview/truth_bench.h"

namespace nephele::truth {
namespace {

using namespace testing_truth;
using glm::vec3;

TEST(TruthPhase, IntegratesToOneWithMeanCosineG) {
  const vec3 along = glm::normalize(vec3(0.3f, -0.5f, 0.8f));
  for (const float g : {-0.999f, -0.9f, -0.3f, 0.0f, 1e-7f, 0.3f, 0.85f, 0.999f}) {
    // Substituting the distribution's own inverse, as sampling does, would hide an error of both: plain
    // quadrature in log (1 ∓ cosθ), which resolves the peak.
    constexpr int kSteps = 20000;
    double whole = 0.0, cosine = 0.0;
    const double low = std::log(1e-12), high = std::log(2.0);
    for (int i = 0; i < kSteps; ++i) {
      const double apart = std::exp(low + (i + 0.5) / kSteps * (high - low));
      const double c = g < 0.0f ? apart - 1.0 : 1.0 - apart;
      const double s = std::sqrt(apart * (2.0 - apart));
      const vec3 next = directionAround(along, static_cast<float>(c), static_cast<float>(s), 0.37f);
      const double weight = double{PhaseFunction{g}.density(along, next)} * 2.0 * std::numbers::pi * apart *
                            (high - low) / kSteps;
      whole += weight;
      cosine += weight * c;
    }
    EXPECT_NEAR(whole, 1.0, 2e-3) << g;
    EXPECT_NEAR(cosine, double{g}, 2e-3) << g;
  }
}

TEST(TruthPhase, SampledDirectionsAreUnitAndHaveMeanCosineG) {
  const vec3 along = glm::normalize(vec3(-0.1f, 0.2f, -0.97f));
  for (const float g : {-0.999f, -0.6f, 0.0f, 0.6f, 0.999f}) {
    constexpr uint32_t kCount = 1u << 14;
    vec3 sum(0.0f);
    double cosine = 0.0;
    for (uint32_t i = 0; i < kCount; ++i) {
      const vec3 next = PhaseFunction{g}.sample(along, stratified(0, i, 7), stratified(1, i, 7));
      ASSERT_NEAR(double{glm::length(next)}, 1.0, 1e-6);
      cosine += double{glm::dot(next, along)} / kCount;
      sum += next / static_cast<float>(kCount);
    }
    EXPECT_NEAR(cosine, double{g}, 1e-3) << g;
    EXPECT_NEAR(double{glm::length(sum - g * along)}, 0.0, 2e-3) << g;  // nothing to the side
  }
}

TEST(TruthRandom, EveryDimensionFillsEveryStratumOnce) {
  constexpr uint32_t kBlock = 64;
  for (const uint64_t seed : {1u, 2u, 99u})
    for (int dimension = 0; dimension < kStratifiedDimensions; ++dimension) {
      std::set<int> strata;
      for (uint32_t i = 0; i < kBlock; ++i) {
        const float u = stratified(dimension, i, seed);
        ASSERT_TRUE(u >= 0.0f && u < 1.0f);
        strata.insert(static_cast<int>(u * kBlock));
      }
      EXPECT_EQ(strata.size(), kBlock) << "dimension " << dimension;
    }
}

TEST(TruthRandom, PixelPlacesFillEveryElementaryRectangleOnce) {
  for (int columns = 1; columns <= 64; columns *= 2) {
    std::set<int> cells;
    for (uint32_t i = 0; i < 64; ++i)
      cells.insert(static_cast<int>(stratified(0, i, 5) * static_cast<float>(columns)) * 64 +
                   static_cast<int>(stratified(1, i, 5) * static_cast<float>(64 / columns)));
    EXPECT_EQ(cells.size(), 64u) << columns;
  }
}

TrackedMedium mediumFor(const BrickVolume& bricks, const vec3& sigmaT, const vec3& sigmaS) {
  TrackedMedium medium;
  medium.bricks = &bricks;
  medium.sigmaT = sigmaT;
  medium.sigmaS = sigmaS;
  medium.sigmaMax = std::max({sigmaT.x, sigmaT.y, sigmaT.z});
  medium.grey = sigmaT == vec3(medium.sigmaMax);
  const glm::dmat3 worldFromIndex(bricks.worldFromIndex);
  medium.worldFromIndex = glm::mat3(worldFromIndex);
  medium.indexFromWorld = glm::mat3(glm::inverse(worldFromIndex));
  medium.grid = buildControlGrid(bricks, double{medium.sigmaMax});
  return medium;
}

/// Of many estimates along one line: their mean must lie within five of its own deviations of `expected`.
void expectTransmittance(const TrackedMedium& medium, const TrackedRay& ray, const glm::dvec3& expected) {
  Random random(11);
  constexpr int kCount = 20000;
  glm::dvec3 sum(0.0), squares(0.0);
  uint64_t looks = 0;
  for (int i = 0; i < kCount; ++i) {
    const vec3 t = transmittance(medium, ray, random, looks);
    for (int c = 0; c < 3; ++c) ASSERT_GE(t[c], 0.0f);
    sum += glm::dvec3(t) / double{kCount};
    squares += glm::dvec3(t * t) / double{kCount};
  }
  for (int c = 0; c < 3; ++c) {
    const double deviation = std::sqrt(std::max(squares[c] - sum[c] * sum[c], 0.0) / kCount);
    EXPECT_NEAR(sum[c], expected[c], 5.0 * deviation + 2e-6) << "channel " << c << ", looks " << looks;
  }
}

/// ∫ ρ dt over [0, reach], by small steps.
double columnBySteps(const BrickVolume& bricks, const TrackedRay& ray, double reach) {
  constexpr int kSteps = 40000;
  const glm::dvec3 corner(bricks.brickMin * kBrickCells);
  double column = 0.0;
  for (int i = 0; i < kSteps; ++i)
    column += densityAt(
        bricks, corner + glm::dvec3(ray.origin) + (i + 0.5) / kSteps * reach * glm::dvec3(ray.direction));
  return column * reach / kSteps;
}

TEST(TruthTracking, TransmittanceOfACloudIsUnbiasedInEveryChannelAndCellSize) {
  const BrickVolume bricks =
      volumeOf({40, 40, 40}, {-20, -20, -20}, glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 20.0); });
  std::set<int> edges;
  for (const float sigma : {0.002f, 0.1f, 2.0f})
    for (const bool grey : {true, false}) {
      const vec3 sigmaT = grey ? vec3(sigma) : sigma * vec3(1.0f, 0.4f, 0.0f);
      const TrackedMedium medium = mediumFor(bricks, sigmaT, sigmaT);
      edges.insert(medium.grid.edge);
      for (const vec3 direction :
           {vec3(1.0f, 0.2f, 0.1f), vec3(0.0f, -0.0f, 1.0f), vec3(0.0f, 1e-38f, -2.0f)}) {
        TrackedRay ray{vec3(0.0f), direction, 1e9f};
        ray.origin = vec3(24.0f) - 20.0f * glm::normalize(direction);
        const double column = columnBySteps(bricks, ray, 60.0);
        expectTransmittance(medium, ray, glm::exp(-column * glm::dvec3(sigmaT)));
      }
    }
  EXPECT_GE(edges.size(), 2u);  // cells of half a brick, and larger ones
}

TEST(TruthTracking, HomogeneousBoxNeedsNoLooksInside) {
  const BrickVolume bricks =
      volumeOf({64, 64, 64}, {0, 0, 0}, glm::dmat4(1.0), [](const glm::dvec3&) { return 0.5; });
  const TrackedMedium medium = mediumFor(bricks, vec3(0.1f), vec3(0.1f));
  Random random(3);
  uint64_t looks = 0;
  const vec3 corner(bricks.brickMin * kBrickCells);
  const TrackedRay ray{vec3(20.0f) - corner, vec3(1.0f, 0.0f, 0.0f), 30.0f};
  EXPECT_NEAR(double{transmittance(medium, ray, random, looks).x}, std::exp(-0.1 * 0.5 * 30.0), 1e-6);
  EXPECT_EQ(looks, 0u);
}

TEST(TruthTracking, LinearRampIsTheMeanOfItsEnds) {
  const BrickVolume bricks =
      volumeOf({16, 16, 64}, {0, 0, 0}, glm::dmat4(1.0), [](const glm::dvec3& p) { return p.z / 63.0; });
  const TrackedMedium medium = mediumFor(bricks, vec3(0.2f), vec3(0.2f));
  const vec3 corner(bricks.brickMin * kBrickCells);
  const TrackedRay ray{vec3(7.3f, 8.1f, 3.0f) - corner, vec3(0.0f, 0.0f, 1.0f), 50.0f};
  const double optical = 0.2 * 0.5 * (3.0 / 63.0 + 53.0 / 63.0) * 50.0;
  expectTransmittance(medium, ray, glm::dvec3(std::exp(-optical)));
}

TEST(TruthTracking, ExponentialRampHasItsClosedForm) {
  const double scale = 20.0;
  const BrickVolume bricks = volumeOf({16, 16, 64}, {0, 0, 0}, glm::dmat4(1.0),
                                      [&](const glm::dvec3& p) { return std::exp(-p.z / scale); });
  const TrackedMedium medium = mediumFor(bricks, vec3(0.1f), vec3(0.1f));
  const vec3 corner(bricks.brickMin * kBrickCells);
  const TrackedRay ray{vec3(7.3f, 8.1f, 0.0f) - corner, vec3(0.0f, 0.0f, 1.0f), 60.0f};
  // Trilinear between samples, the exponential is too large by 1/(12 · scale²).
  const double optical = 0.1 * scale * (1.0 - std::exp(-60.0 / scale)) * (1.0 + 1.0 / (12.0 * scale * scale));
  expectTransmittance(medium, ray, glm::dvec3(std::exp(-optical)));
}

TEST(TruthTracking, CollisionsFallOffAsTransmittance) {
  const BrickVolume bricks =
      volumeOf({40, 40, 40}, {-20, -20, -20}, glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 20.0); });
  for (const bool grey : {true, false}) {
    const vec3 sigmaT = grey ? vec3(0.1f) : vec3(0.1f, 0.05f, 0.02f);
    const TrackedMedium medium = mediumFor(bricks, sigmaT, sigmaT);
    const TrackedRay start{vec3(4.0f, 20.0f, 22.0f), vec3(1.0f, 0.1f, 0.0f), 1e9f};
    const double column = columnBySteps(bricks, start, 60.0);
    Random random(5);
    uint64_t looks = 0;
    constexpr int kCount = 40000;
    glm::dvec3 escaped(0.0), scattered(0.0);
    for (int i = 0; i < kCount; ++i) {
      TrackedRay ray = start;
      vec3 weight(1.0f);
      const bool found = nextCollision(medium, ray, weight, random, looks);
      (found ? scattered : escaped) += glm::dvec3(weight) / double{kCount};
    }
    // Weights stay below 3 (one channel of three may carry all): five deviations of the mean are 0.02.
    for (int c = 0; c < 3; ++c) {
      const double through = std::exp(-column * double{sigmaT[c]});
      EXPECT_NEAR(escaped[c], through, 0.02) << "channel " << c;
      EXPECT_NEAR(scattered[c], 1.0 - through, 0.02) << "channel " << c;
    }
  }
}

TEST(TruthTracking, FirstScatteringTakesWhatTheRayLoses) {
  const BrickVolume bricks = smallCloud();
  for (const vec3 sigmaT : {vec3(0.01f), vec3(4.0f), vec3(4.0f, 1.0f, 0.0f), vec3(4000.0f)}) {
    const TrackedMedium medium = mediumFor(bricks, sigmaT, 0.5f * sigmaT);
    const TrackedRay ray{vec3(0.0f, 13.0f, 15.0f), vec3(12.0f, 1.0f, 0.5f), 1e9f};
    const double column = columnBySteps(bricks, ray, 5.0);
    Random random(9);
    uint64_t looks = 0;
    constexpr uint32_t kCount = 1u << 14;
    glm::dvec3 scattered(0.0), through(0.0);
    for (uint32_t i = 0; i < kCount; ++i) {
      const FirstScattering first =
          firstScattering(medium, ray, stratified(0, i, 3), stratified(1, i, 3), random, looks);
      scattered += glm::dvec3(first.weight) / double{kCount};
      through += glm::dvec3(first.transmittance) / double{kCount};
    }
    for (int c = 0; c < 3; ++c) {
      const double expected = std::exp(-column * double{sigmaT[c]});
      EXPECT_NEAR(through[c], expected, 0.01) << sigmaT.x << " channel " << c;
      EXPECT_NEAR(scattered[c], 0.5 * (1.0 - expected), 0.01 * std::max(1.0 - expected, 1e-3))
          << sigmaT.x << " channel " << c;
    }
  }
}

}  // namespace
}  // namespace nephele::truth
