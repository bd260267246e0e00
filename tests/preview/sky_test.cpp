// The environment's shared text: against the double-precision witness in scene/, closed forms of its energy,
// and directions drawn without bias.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "preview/gpu/light_parameters.h"
#include "preview/gpu/sub_pixels.h"
#include "preview/twin/march.h"
#include "scene/sky.h"

namespace nephele::shared {
namespace {

constexpr double kPiDouble = std::numbers::pi;

struct NoBricks : NoCache {
  uvec2 word(ivec3) const { return uvec2(0u); }
  float density(uvec2, vec3, ivec3) const { return 0.0f; }
};
struct FullBricks : NoCache {
  uvec2 word(ivec3) const { return uvec2(0xf8000000u, 0u); }
  float density(uvec2, vec3, ivec3) const { return 1.0f; }
};

ViewedScene rampView(double cloudiness, const glm::dvec3& up) {
  ViewedScene view;
  view.up = up;
  view.scene.environment.kind = Environment::Kind::ramp;
  view.scene.environment.ramp = {{0.3, 0.2, 0.1}, {0.9, 1.0, 1.1}, {0.1, 0.3, 0.8}, cloudiness, 1.5};
  return view;
}

ViewedScene mapView(int width, int height, double rotation) {
  std::vector<glm::vec3> texels;
  for (int i = 0; i < width * height; ++i) {
    const float f = static_cast<float>(i);
    texels.push_back({1.0f + std::sin(0.7f * f), 1.0f + std::cos(0.9f * f), 0.5f});
  }
  texels[static_cast<size_t>(width * height / 3)] = glm::vec3(80.0f, 60.0f, 40.0f);
  ViewedScene view;
  view.scene.environment.kind = Environment::Kind::exr;
  view.scene.environment.exr = {"made", rotation, 0.7};
  view.environmentMap =
      std::make_shared<const EnvironmentMap>(makeEnvironmentMap("made", width, height, std::move(texels)));
  return view;
}

/// The shared text over the environment of a view.
March<NoBricks> marchOver(const ViewedScene& view) {
  MarchParameters p{};
  setLightParameters(p, view, BrickVolume{}, IndexFrame{});
  March<NoBricks> march{p, nullptr};
  if (view.environmentMap)
    march.skyArrays = {view.environmentMap->texels.data(), view.environmentMap->cells.data()};
  return march;
}

/// Directions spread evenly over the sphere: a Fibonacci spiral.
glm::dvec3 spiral(int i, int count) {
  const double z = 1.0 - (2.0 * i + 1.0) / count, angle = kPiDouble * (3.0 - std::sqrt(5.0)) * i;
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(SharedSky, AngleIsTheArcTangent) {
  March<NoBricks> march{};
  double worst = 0.0;
  for (double angle = -kPiDouble + 1e-3; angle < kPiDouble; angle += 1e-3) {
    const float y = static_cast<float>(3.0 * std::sin(angle)), x = static_cast<float>(3.0 * std::cos(angle));
    worst = std::max(worst, std::abs(double{march.angleOf(y, x)} - std::atan2(double{y}, double{x})));
  }
  EXPECT_LT(worst, 5e-7);
  EXPECT_EQ(march.angleOf(0.0f, 0.0f), 0.0f);
  EXPECT_NEAR(double{march.angleOf(0.0f, -2.0f)}, kPiDouble, 1e-6);
}

TEST(SharedSky, EachKindIsTheWitnesses) {
  ViewedScene constant;
  constant.scene.environment.constant = {0.1, 0.2, 0.3};
  for (const ViewedScene& view : {constant, rampView(0.0, {0, 0, 1}), rampView(1.0, {0, 1, 0}),
                                  mapView(37, 19, 0.4), mapView(1, 1, 0.0)}) {
    March<NoBricks> march = marchOver(view);
    constexpr int kDirections = 2000;
    for (int i = 0; i < kDirections; ++i) {
      const glm::dvec3 d = spiral(i, kDirections);
      const glm::dvec3 expected = skyRadiance(view.scene.environment, view.environmentMap.get(), view.up, d);
      const vec3 actual = march.environmentRadiance(vec3(d));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(double{actual[c]}, expected[c], 5e-4 * std::max(1.0, expected[c]))
            << nameOf(view.scene.environment.kind) << ' ' << i;
    }
  }
}

TEST(SharedSky, RampsEnergyHasItsClosedForm) {
  // Over a half of the sphere ∫ L dΩ = 2π (far + (horizon − far)/(n + 1)), and the irradiance from above
  // ∫ L z dΩ = 2π (far/2 + (horizon − far)/((n + 1)(n + 2))).
  for (double cloudiness : {0.0, 0.4, 1.0}) {
    const ViewedScene view = rampView(cloudiness, {0, 0, 1});
    March<NoBricks> march = marchOver(view);
    const RampShape shape = rampShape(cloudiness);
    double above = 0.0, irradiance = 0.0, below = 0.0;
    constexpr int kNodes = 40000;
    for (int i = 0; i < kNodes; ++i) {
      const double z = (i + 0.5) / kNodes;
      const double up = double{march.rampRadiance(static_cast<float>(z)).z};
      above += 2.0 * kPiDouble * up / kNodes;
      irradiance += 2.0 * kPiDouble * up * z / kNodes;
      below += 2.0 * kPiDouble * double{march.rampRadiance(static_cast<float>(-z)).z} / kNodes;
    }
    const double n = shape.skyPower, m = shape.groundPower, ground = 1.5 * shape.groundFactor * 0.1;
    const double zenith = 1.5 * 0.8, horizon = 1.5 * 1.1;
    EXPECT_NEAR(above, 2.0 * kPiDouble * (zenith + (horizon - zenith) / (n + 1.0)), 1e-3);
    EXPECT_NEAR(irradiance, 2.0 * kPiDouble * (0.5 * zenith + (horizon - zenith) / ((n + 1.0) * (n + 2.0))),
                1e-3);
    EXPECT_NEAR(below, 2.0 * kPiDouble * (ground + (horizon - ground) / (m + 1.0)), 1e-3);
  }
}

TEST(SharedSky, TheMeanOfARampIsThatOfItsDirections) {
  for (double cloudiness : {0.0, 0.4, 1.0}) {
    const ViewedScene view = rampView(cloudiness, {0, 0, 1});
    glm::dvec3 sum(0.0);
    constexpr int kNodes = 40000;
    for (int i = 0; i < kNodes; ++i) {
      const double z = 2.0 * (i + 0.5) / kNodes - 1.0;
      sum +=
          skyRadiance(view.scene.environment, nullptr, view.up, glm::dvec3(std::sqrt(1.0 - z * z), 0.0, z));
    }
    const glm::dvec3 mean = meanSkyRadiance(view.scene.environment);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], sum[c] / kNodes, 1e-4) << cloudiness;
  }
}

TEST(SharedSky, DirectionsDrawnFromAMapHaveTheDensityItSays) {
  const ViewedScene view = mapView(40, 20, 0.8);
  March<NoBricks> march = marchOver(view);
  // Σ 1/density over draws is the solid angle of all cells that can be drawn: the whole sphere here.
  constexpr int kDraws = 400000;
  double solidAngle = 0.0, energy = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    uint state = static_cast<uint>(i);
    const uint bits = static_cast<uint>(i) * 2654435769u;
    const float u1 = nextUniform(state), u2 = nextUniform(state);
    const vec3 d = march.drawFromMap(bits, u1, u2);
    EXPECT_NEAR(double{dot(d, d)}, 1.0, 1e-5);
    const double density = double{march.mapDensity(d)};
    ASSERT_GT(density, 0.0);
    solidAngle += 1.0 / density / kDraws;
    energy += double{march.environmentRadiance(d).x} / density / kDraws;
  }
  double expected = 0.0;
  constexpr int kDirections = 400000;
  for (int i = 0; i < kDirections; ++i)
    expected +=
        4.0 * kPiDouble / kDirections *
        skyRadiance(view.scene.environment, view.environmentMap.get(), view.up, spiral(i, kDirections)).x;
  EXPECT_NEAR(solidAngle / (4.0 * kPiDouble), 1.0, 1e-2);
  EXPECT_NEAR(energy / expected, 1.0, 1e-2);
}

// Numbers of one sample that go on in step would cover a line of the square: pictures would settle on another
// mean.
TEST(SharedSky, DirectionsKnowNothingOfASamplesOtherNumbers) {
  March<NoBricks> march = marchOver(rampView(0.3, {0, 0, 1}));
  march.params.counts.w = 1;
  constexpr int kCells = 16;
  constexpr uint kNumbers = 4096;
  const vec3 ray(0.0f, 0.0f, 1.0f);
  const auto cell = [](float share) { return std::min(static_cast<int>(share * kCells), kCells - 1); };
  std::set<std::pair<int, int>> withStart, withLit, withPixel;
  for (uint number = 0; number < kNumbers; ++number) {
    const float start = march.stepStart(0.3f, number);
    const int along = cell(0.5f - 0.5f * dot(ray, march.lightingFromSky(ray, 2u, number, 0u).toLight));
    withStart.insert({cell(start), along});
    withLit.insert({cell(march.litStart(start, 2u, number)), along});
    withPixel.insert({cell(subPixelOffset(number, 0).x), along});
  }
  // Of 4096 places drawn at random none of 256 cells would be left out but once in 30 times.
  constexpr size_t kMost = kCells * kCells, kLeast = kMost - 2;
  EXPECT_GE(withStart.size(), kLeast);
  EXPECT_GE(withLit.size(), kLeast);
  EXPECT_GE(withPixel.size(), kLeast);
}

// Isotropic, so that the cosine to the ray is even over the directions of either way of drawing them.
TEST(SharedSky, PlacesAlongARayShareAnEvenSetOfDirections) {
  March<NoBricks> march = marchOver(rampView(0.3, {0, 0, 1}));
  march.params.counts.w = 1;
  march.params.phase = vec4(0.0f);
  constexpr uint kPlaces = 16, kWays = 2;
  const vec3 ray(0.0f, 0.0f, 1.0f);
  const auto share = [&](uint number, uint place) {
    return double{0.5f - 0.5f * dot(ray, march.lightingFromSky(ray, 5u, number, place).toLight)};
  };
  // How many of a run's numbers fall into each of `bins`, for one place or for all of a set.
  const auto spread = [&](uint first, uint run, uint firstPlace, uint places, size_t bins) {
    std::vector<uint> in(bins, 0);
    for (uint number = first; number < first + run; ++number)
      for (uint place = firstPlace; place < firstPlace + places; ++place)
        ++in[std::min(static_cast<size_t>(share(number, place) * static_cast<double>(bins)), bins - 1)];
    return in;
  };
  for (const auto& [first, run] : {std::pair{0u, 8u}, {8u, 8u}, {16u, 16u}, {64u, 64u}}) {
    SCOPED_TRACE(first);
    for (uint place = 0; place < 2 * kPlaces; ++place)
      EXPECT_EQ(spread(first, run, place, 1, run / kWays), std::vector<uint>(run / kWays, kWays)) << place;
    for (const uint set : {0u, kPlaces}) {
      const size_t bins = kPlaces * run / kWays;
      EXPECT_EQ(spread(first, run, set, kPlaces, bins), std::vector<uint>(bins, kWays)) << set;
    }
  }
  EXPECT_NE(share(0, 0), share(0, kPlaces)) << "the next set looks elsewhere";
  EXPECT_NE(share(0, 0), share(8, 0)) << "and so does the next run";
}

TEST(SharedSky, EveryKindLightsAThinMediumByItsMean) {
  // Optical depth x ≪ 1, isotropic: the mean over directions times x, from every way of drawing them.
  for (const ViewedScene& view : {rampView(0.3, {0, 0, 1}), mapView(16, 8, 0.0)}) {
    const FullBricks bricks;
    MarchParameters p{};
    setLightParameters(p, view, BrickVolume{}, IndexFrame{});
    p.originCorner = vec4(0.0f, 104.0f, 104.0f, 0.0f);
    p.directionCorner = p.rayCorner = vec4(1.0f, 0.0f, 0.0f, 0.0f);
    p.worldFromIndexX = p.indexFromWorldX = vec4(1.0f, 0.0f, 0.0f, 0.0f);
    p.worldFromIndexY = p.indexFromWorldY = vec4(0.0f, 1.0f, 0.0f, 0.0f);
    p.worldFromIndexZ = p.indexFromWorldZ = vec4(0.0f, 0.0f, 1.0f, 0.0f);
    p.boxMin = vec4(100.0f, 0.0f, 0.0f, 0.0f);
    p.boxMax = vec4(108.0f, 208.0f, 208.0f, 0.0f);
    p.sigmaT = vec4(vec3(1e-7f), 0.0f);
    p.sigmaS = vec4(vec3(1e-7f), 0.5f);
    p.phase = vec4(0.0f);
    p.shadow = vec4(4.0f, 2.0f, 1.0f, 1.0f);
    p.environment.w = 1e-6f;
    p.walk = vec4(1e-4f, 1.0f, 0.0f, 0.0f);
    p.brickCount = ivec4(26, 26, 26, 0);
    March<FullBricks> march{p, &bricks};
    if (view.environmentMap)
      march.skyArrays = {view.environmentMap->texels.data(), view.environmentMap->cells.data()};
    constexpr int kRays = 20000, kDirections = 100000;
    double mean = 0.0, expected = 0.0;
    for (uint i = 0; i < kRays; ++i)
      mean += double{march.marchRay(vec2(0.0f), 0.5f, hashBits(i), i).radiance.x} / kRays;
    for (int i = 0; i < kDirections; ++i)
      expected +=
          skyRadiance(view.scene.environment, view.environmentMap.get(), view.up, spiral(i, kDirections)).x /
          kDirections;
    EXPECT_NEAR(mean / (8.0 * 1e-7) / expected, 1.0, 1.5e-2) << nameOf(view.scene.environment.kind);
  }
}

TEST(LightParameters, HeightRunsOverTheWorldBoxOfTheActiveVoxels) {
  glm::dmat4 worldFromIndex(1.0);
  worldFromIndex[0] = glm::dvec4(0.0, 0.0, -0.5, 0.0);  // the index's x falls along the world's z
  worldFromIndex[2] = glm::dvec4(2.0, 0.0, 0.0, 0.0);
  worldFromIndex[3] = glm::dvec4(5.0, 6.0, 7.0, 1.0);
  const BrickVolume bricks =
      bricksFromDense(std::vector<float>(6 * 8 * 10, 2.0f), {6, 8, 10}, {-3, 4, 5}, worldFromIndex);
  MarchParameters p{};
  setLightParameters(p, ViewedScene{}, bricks, frameOf(bricks));
  const auto height = [&](double x) {
    const glm::dvec3 position = glm::dvec3(x, 6.0, 7.0) - glm::dvec3(bricks.brickMin * kBrickCells);
    return double{dot(vec3(position), vec3(p.height)) + p.height.w};
  };
  EXPECT_NEAR(height(-3.5), 1.0, 1e-6);
  EXPECT_NEAR(height(2.5), 0.0, 1e-6);
  EXPECT_NEAR(double{p.powder.y}, 0.5, 1e-6);
  EXPECT_EQ(p.powder.x, 0.0f) << "physical";
  EXPECT_NEAR(double{p.chordRadii.y}, 4.0, 1e-6);
  EXPECT_NEAR(double{p.chordCentre.w}, 2.0, 1e-6);
}

TEST(LightParameters, NumbersKindsAsTheSharedTextDoes) {
  using M = March<NoBricks>;
  EXPECT_EQ(marchOver(ViewedScene{}).skyKind(), kSkyNone);
  ViewedScene constant;
  constant.scene.environment.constant = {0.1, 0.0, 0.0};
  EXPECT_EQ(marchOver(constant).skyKind(), kSkyConstant);
  EXPECT_EQ(marchOver(rampView(0.0, {0, 0, 1})).skyKind(), kSkyRamp);
  EXPECT_EQ(marchOver(mapView(2, 2, 0.0)).skyKind(), kSkyMap);
  EXPECT_EQ(M::kSkyCellsAround, kEnvironmentCellsAround);
  EXPECT_EQ(M::kSkyCellsUp, kEnvironmentCellsUp);
  EXPECT_EQ(1 << (32 - M::kSkyCellShift), kEnvironmentCells);
}

}  // namespace
}  // namespace nephele::shared
