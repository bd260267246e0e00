// The shared march alone, over densities given as formulas: the sphere's closed form, lights at a distance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/twin/march.h"

namespace nephele::shared {
namespace {

/// Density 1 everywhere.
struct FullBricks {
  uint slot(ivec3) const { return 1u; }
  float density(uint, vec3) const { return 1.0f; }
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
  p.shadow = vec4(1.0f, 1.0f, 0.0f, 0.0f);
  p.environment = vec4(0.0f, 0.0f, 0.0f, 1e-6f);
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
    const auto result = march.marchRay(vec2(0.0f), 1u, 0u);
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
  p.shadow = vec4(0.05f, 1.0f, 0.0f, 0.0f);
  March<FullBricks> march{p, &bricks};
  const auto result = march.marchRay(vec2(0.0f), 1u, 0u);
  const double depth = 0.03 * 64.0;
  const double expected = depth * std::exp(-depth) / (4.0 * std::numbers::pi);
  // The step integral spreads each step's source over its attenuation: second order in a step of depth
  // 0.0015.
  EXPECT_NEAR(double{result.radiance.x} / (2.0 * expected), 1.0, 2e-3);
  EXPECT_NEAR(double{result.radiance.z} / double{result.radiance.x}, 2.0, 1e-5);
}

TEST(SharedMarch, PointLightFallsWithTheSquareOfItsDistance) {
  const FullBricks bricks;
  auto p = parametersFor(100.0f, 101.0f, 1e-6f);
  p.counts.x = 1;
  p.lights[0] = {vec4(0.0f, 0.0f, 0.0f, float(kLightPoint)), vec4(100.5f, 124.0f, 104.0f, 0.0f), vec4(5.0f)};
  March<FullBricks> march{p, &bricks};
  const double near = double{march.marchRay(vec2(0.0f), 1u, 0u).radiance.x};
  march.params.lights[0].directionIndex.y = 144.0f;
  const double far = double{march.marchRay(vec2(0.0f), 1u, 0u).radiance.x};
  EXPECT_NEAR(near / far, 4.0, 2e-3);  // the two samples lie a quarter voxel off the point's foot
  EXPECT_NEAR(near, 1e-6 * 5.0 / 400.0 / (4.0 * std::numbers::pi), 1e-3 * near);
}

TEST(SharedMarch, UniformSkyThroughThinMediumGivesOpticalDepth) {
  // Optical depth x ≪ 1 under a sky of radiance 1: the mean over directions is x, whatever g.
  const FullBricks bricks;
  auto p = parametersFor(40.0f, 168.0f, 1e-7f);
  p.environment = vec4(1.0f, 1.0f, 1.0f, 1e-6f);
  p.sigmaT.w = 0.7f;
  March<FullBricks> march{p, &bricks};
  constexpr int kRays = 4000;
  double mean = 0.0;
  for (uint i = 0; i < kRays; ++i)
    mean += double{march.marchRay(vec2(0.0f), hashBits(i), i).radiance.x} / kRays;
  // 32 directions a ray of variance below 1: 4000 rays leave 3e-3 at one deviation.
  EXPECT_NEAR(mean / (128.0 * 1e-7), 1.0, 1.2e-2);
}

TEST(SharedMarch, NoLightNoMediumNothing) {
  const FullBricks bricks;
  auto p = parametersFor(40.0f, 168.0f, 0.0f);
  March<FullBricks> march{p, &bricks};
  const auto result = march.marchRay(vec2(0.0f), 1u, 0u);
  EXPECT_EQ(result.radiance.x, 0.0f);
  EXPECT_EQ(result.opticalDepth.x, 0.0f);
  EXPECT_EQ(result.depthWeight, 0.0f);
}

}  // namespace
}  // namespace nephele::shared
