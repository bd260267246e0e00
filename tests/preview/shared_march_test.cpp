// The shared march alone, over densities given as formulas: the sphere's closed form, lights at a distance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/twin/march.h"

namespace nephele::shared {
namespace {

constexpr uint kMostWord = 248;  // a brick whose samples reach the volume's maximum

/// Density 1 everywhere.
struct FullBricks : NoCache {
  uvec2 word(ivec3) const { return uvec2(kMostWord << 24u, 0u); }
  float density(uvec2, vec3, ivec3) const { return 1.0f; }
};

/// Looks along +x from outside; the medium fills [left, right] in x.
MarchParameters parametersFor(float left, float right, float sigmaT) {
  MarchParameters p{};
  p.originCorner = vec4(0.0f, 104.0f, 104.0f, 0.0f);
  p.directionCorner = vec4(1.0f, 0.0f, 0.0f, 0.0f);
  p.rayCorner = p.directionCorner;
  p.worldFromIndexX = p.indexFromWorldX = vec4(1.0f, 0.0f, 0.0f, 0.0f);
  p.worldFromIndexY = p.indexFromWorldY = vec4(0.0f, 1.0f, 0.0f, 0.0f);
  p.worldFromIndexZ = p.indexFromWorldZ = vec4(0.0f, 0.0f, 1.0f, 0.0f);
  p.boxMin = vec4(left, 0.0f, 0.0f, 0.0f);
  p.boxMax = vec4(right, 208.0f, 208.0f, 0.0f);
  p.sigmaT = vec4(vec3(sigmaT), 0.0f);
  p.sigmaS = vec4(vec3(sigmaT), 0.5f);
  p.octaves = vec4(0.5f, 0.5f, 0.5f, 0.0f);
  p.shadow = vec4(1.0f, 1.0f, 1.0f, 1.0f);
  p.environment = vec4(0.0f, 0.0f, 0.0f, 1e-6f);
  p.walk = vec4(1e-4f, 1.0f, 0.0f, 0.0f);
  p.brickCount = ivec4(26, 26, 26, 0);
  return p;
}

TEST(SharedMarch, HomogeneousSphereIsBeerLambertAlongTheChord) {
  const FullBricks bricks;
  const double radius = 100.0, sigmaT = 4.0 / (2.0 * radius);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double impact = radius * i / 1000.0;
    const double half = std::sqrt(radius * radius - impact * impact);
    const auto p = parametersFor(static_cast<float>(104.0 - half), static_cast<float>(104.0 + half),
                                 static_cast<float>(sigmaT));
    March<FullBricks> march{p, &bricks};
    const auto result = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
    worst =
        std::max(worst, std::abs(std::exp(-double{result.opticalDepth.x}) - std::exp(-sigmaT * 2.0 * half)));
  }
  std::printf("homogeneous sphere, shared functions alone: largest error of transmittance %.3g\n", worst);
  EXPECT_LT(worst, 1e-6);
}

TEST(SharedMarch, SingleScatteringBackLitSlabHasItsClosedForm) {
  // Sun straight ahead behind a slab of depth L: L_s = E p(0) ∫ σ e^(−σ s) e^(−σ (L − s)) ds = E p(0) σ L
  // e^(−σ L).
  const FullBricks bricks;
  auto p = parametersFor(20.0f, 84.0f, 0.03f);
  p.counts.x = 1;
  p.lights[0] = {vec4(1.0f, 0.0f, 0.0f, float(kLightSun)), vec4(1.0f, 0.0f, 0.0f, 0.0f),
                 vec4(2.0f, 3.0f, 4.0f, 0.0f)};
  p.sigmaS.w = 0.05f;
  p.shadow = vec4(0.05f, 1.0f, 1.0f, 1.0f);
  March<FullBricks> march{p, &bricks};
  const auto result = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
  const double depth = 0.03 * 64.0;
  const double expected = depth * std::exp(-depth) / (4.0 * std::numbers::pi);
  // The step integral spreads each step's source over its attenuation: second order in a step of depth
  // 0.0015.
  EXPECT_NEAR(double{result.radiance.x} / (2.0 * expected), 1.0, 2e-3);
  EXPECT_NEAR(double{result.radiance.z} / double{result.radiance.x}, 2.0, 1e-5);
}

/// Density that falls evenly from 1 at x = 0 to 0 at x = 208.
struct FallingBricks : NoCache {
  uvec2 word(ivec3 brick) const { return uvec2(kMostWord << 24u | uint(brick.x), 0u); }
  float density(uvec2 word, vec3 kept, ivec3) const {
    return 1.0f - (8.0f * float(word.x & 4095u) + kept.x) / 208.0f;
  }
};

TEST(SharedMarch, ColumnsTowardsASunDoNotDependOnWhereStepsAreRead) {
  const FallingBricks bricks;
  for (const float growth : {1.0f, 1.1f, 1.3f}) {
    auto p = parametersFor(0.0f, 208.0f, 1.0f);
    p.shadow = vec4(4.0f, growth, 1.0f, 1.0f);
    March<FallingBricks> march{p, &bricks};
    // ∫ 1 − x/208 dx from 48 on: 160 is a whole number of even steps.
    constexpr double kExact = 160.0 * 160.0 / (2.0 * 208.0);
    double least = 1e30, most = 0.0, plain = 0.0;
    for (int i = 0; i < 16; ++i) {
      const float start = (static_cast<float>(i) + 0.5f) / 16.0f;
      vec4 cost(0.0f);
      const vec3 from(48.0f, 104.0f, 104.0f), along(1.0f, 0.0f, 0.0f);
      const double column =
          double{march.columnTowards(from, 160.0f / 208.0f, along, march.kSunReach, 1e30f, start, cost)};
      least = std::min(least, column);
      most = std::max(most, column);
      plain = std::max(plain, double{march.columnDensity(from, along, march.kSunReach, 1e30f,
                                                         vec2(4.0f, growth), start, cost)});
    }
    std::printf("steps growing by %.1f: columns %.5f to %.5f of the exact one, as read up to %.3f\n",
                double{growth}, least / kExact, most / kExact, plain / kExact);
    // The formula is exact for even steps. Growing ones are cut at the far end, and their first counts twice.
    const double allowed = growth == 1.0f ? 1e-5 : 0.25 * (plain / kExact - 1.0);
    EXPECT_NEAR(least / kExact, 1.0, allowed) << growth;
    EXPECT_NEAR(most / kExact, 1.0, allowed) << growth;
    EXPECT_GT(plain / kExact, 1.02) << growth;
  }
}

TEST(SharedMarch, PointLightFallsWithTheSquareOfItsDistance) {
  const FullBricks bricks;
  auto p = parametersFor(100.0f, 101.0f, 1e-6f);
  p.counts.x = 1;
  p.lights[0] = {vec4(0.0f, 0.0f, 0.0f, float(kLightPoint)), vec4(100.5f, 124.0f, 104.0f, 0.0f), vec4(5.0f)};
  March<FullBricks> march{p, &bricks};
  const double near = double{march.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x};
  march.params.lights[0].directionIndex.y = 144.0f;
  const double far = double{march.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x};
  EXPECT_NEAR(near / far, 4.0, 2e-3);  // the two samples lie a quarter voxel off the point's foot
  EXPECT_NEAR(near, 1e-6 * 5.0 / 400.0 / (4.0 * std::numbers::pi), 1e-3 * near);
}

TEST(SharedMarch, UniformSkyThroughThinMediumGivesOpticalDepth) {
  // Optical depth x ≪ 1 under a sky of radiance 1: the mean over directions is x, whatever g.
  const FullBricks bricks;
  auto p = parametersFor(40.0f, 168.0f, 1e-7f);
  p.environment = vec4(1.0f, 1.0f, 1.0f, 1e-6f);
  p.skyUp = vec4(0.0f, 0.0f, 1.0f, float(kSkyConstant));
  p.phase = vec4(0.7f, -0.4f, 0.3f, 0.0f);
  March<FullBricks> march{p, &bricks};
  constexpr int kRays = 4000;
  double mean = 0.0;
  for (uint i = 0; i < kRays; ++i)
    mean += double{march.marchRay(vec2(0.0f), 0.5f, hashBits(i), i).radiance.x} / kRays;
  // 32 directions a ray of variance below 1: 4000 rays leave 3e-3 at one deviation.
  EXPECT_NEAR(mean / (128.0 * 1e-7), 1.0, 1.2e-2);
}

/// A slab so thin that nothing in it is shaded, lit by one sun along `toLight`.
MarchParameters thinSlab(const vec3& toLight) {
  auto p = parametersFor(100.0f, 108.0f, 1e-7f);
  p.counts.x = 1;
  p.lights[0] = {vec4(toLight, float(kLightSun)), vec4(toLight, 0.0f), vec4(1.0f)};
  return p;
}

TEST(SharedMarch, OctavesSumTheirOrders) {
  // Optical depth x ≪ 1: x Σ b^m p(c^m g), p at the angle between light and view.
  const FullBricks bricks;
  const double g = 0.8, b = 0.6, c = 0.5, depth = 8.0 * 1e-7;
  auto p = thinSlab(vec3(0.6f, 0.0f, 0.8f));
  p.phase = vec4(static_cast<float>(g), 0.0f, 0.0f, 0.0f);
  p.octaves = vec4(0.3f, static_cast<float>(b), static_cast<float>(c), 0.0f);
  for (int count : {0, 1, 5}) {
    p.counts.y = count;
    double expected = 0.0;
    for (int m = 0; m <= count; ++m) {
      const double gm = g * std::pow(c, m);
      expected += depth * std::pow(b, m) * (1.0 - gm * gm) /
                  (4.0 * std::numbers::pi * std::pow(1.0 + gm * gm - 2.0 * gm * 0.6, 1.5));
    }
    const double actual = double{March<FullBricks>{p, &bricks}.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x};
    EXPECT_NEAR(actual / expected, 1.0, 1e-4) << count;
  }
}

TEST(SharedMarch, OctavesSeeTheLightThroughAPowerOfTheExtinction) {
  // A slab of depth 2, the sun straight ahead: order m adds b^m x/(4π) ∫ e^(−x s) e^(−a^m x (1 − s)) ds.
  const FullBricks bricks;
  auto p = parametersFor(20.0f, 84.0f, 2.0f / 64.0f);
  p.counts.x = 1;
  p.lights[0] = {vec4(1.0f, 0.0f, 0.0f, float(kLightSun)), vec4(1.0f, 0.0f, 0.0f, 0.0f), vec4(1.0f)};
  p.sigmaS.w = 0.05f;
  p.shadow = vec4(0.05f, 1.0f, 1.0f, 1.0f);
  p.counts.y = 2;
  p.octaves = vec4(0.5f, 0.4f, 1.0f, 0.0f);
  const double x = 2.0;
  double expected = 0.0;
  for (int m = 0; m <= 2; ++m) {
    const double ax = std::pow(0.5, m) * x;
    const double integral = m == 0 ? std::exp(-x) : (std::exp(-ax) - std::exp(-x)) / (x - ax);
    expected += std::pow(0.4, m) * x * integral / (4.0 * std::numbers::pi);
  }
  const double actual = double{March<FullBricks>{p, &bricks}.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x};
  EXPECT_NEAR(actual / expected, 1.0, 2e-3);
}

TEST(SharedMarch, PowderScalesWhatIsScatteredAndNothingElse) {
  const FullBricks bricks;
  auto p = thinSlab(vec3(0.0f, 0.0f, 1.0f));
  March<FullBricks> march{p, &bricks};
  const auto without = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
  march.params.powder = vec4(0.5f, 0.25f, 0.0f, 0.0f);  // density 1 of at most 4
  march.params.height = vec4(0.0f, 0.0f, 1.0f / 208.0f, 0.0f);
  const auto with = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
  EXPECT_NEAR(double{with.radiance.x / without.radiance.x}, double{powderFactor(0.5f, 0.25f, 0.5f)}, 1e-6);
  EXPECT_EQ(with.opticalDepth.x, without.opticalDepth.x);
}

TEST(SharedMarch, ChordLightsAHomogeneousBallAsMarchingDoes) {
  // The ellipsoid inscribed in a cube, but the cube is full: at its centre both see the same way out along an
  // axis.
  const FullBricks bricks;
  auto p = parametersFor(103.9f, 104.1f, 0.01f);
  p.boxMin.y = p.boxMin.z = 4.0f;
  p.boxMax.y = p.boxMax.z = 204.0f;
  p.counts.x = 1;
  p.lights[0] = {vec4(0.0f, 0.0f, 1.0f, float(kLightSun)), vec4(0.0f, 0.0f, 1.0f, 0.0f), vec4(1.0f)};
  p.shadow = vec4(0.05f, 1.0f, 1.0f, 1.0f);
  March<FullBricks> march{p, &bricks};
  const double marched = double{march.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x};
  march.params.chordCentre = vec4(104.0f, 104.0f, 104.0f, 1.0f);
  march.params.chordRadii = vec4(100.0f, 100.0f, 100.0f, 1.0f);
  const auto chord = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
  EXPECT_NEAR(double{chord.radiance.x} / marched, 1.0, 1e-4);
  march.params.chordCentre.w = 0.5f;
  EXPECT_NEAR(double{march.marchRay(vec2(0.0f), 0.5f, 1u, 0u).radiance.x} / marched, std::exp(0.5), 1e-3);
}

TEST(SharedMarch, EnvironmentBehindIsSeenThroughTheMedium) {
  const FullBricks bricks;
  auto p = parametersFor(40.0f, 168.0f, 0.0f);
  p.environment = vec4(1.0f, 2.0f, 3.0f, 1e-6f);
  p.skyUp = vec4(0.0f, 0.0f, 1.0f, float(kSkyConstant));
  March<FullBricks> march{p, &bricks};
  EXPECT_EQ(march.environmentBehind(vec2(0.0f), vec3(0.0f)).y, 0.0f) << "not asked for";
  march.params.skyForward.w = 1.0f;
  EXPECT_NEAR(double{march.environmentBehind(vec2(0.0f), vec3(0.5f)).y}, 2.0 * std::exp(-0.5), 1e-6);
}

TEST(SharedMarch, NoLightNoMediumNothing) {
  const FullBricks bricks;
  auto p = parametersFor(40.0f, 168.0f, 0.0f);
  March<FullBricks> march{p, &bricks};
  const auto result = march.marchRay(vec2(0.0f), 0.5f, 1u, 0u);
  EXPECT_EQ(result.radiance.x, 0.0f);
  EXPECT_EQ(result.opticalDepth.x, 0.0f);
  EXPECT_EQ(result.depthWeight, 0.0f);
}

}  // namespace
}  // namespace nephele::shared
