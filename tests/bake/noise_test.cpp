// What gradient noise must be: bounded, zero at lattice points, of known slope and mean, periodic where
// asked, and as precise far from the origin as near it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/fields/perlin.h"
#include "bake/fields/shared_text.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

TEST(Perlin, IsZeroAtLatticePoints) {
  for (int n = 0; n < 1000; ++n)
    ASSERT_EQ(shared::perlinNoise({n, -3 * n, n * n}, {0.0f, 0.0f, 0.0f}, 0, 7u), 0.0f);
}

TEST(Perlin, NeverExceedsOneAndComesNearIt) {
  // The value is greatest where every corner's gradient pulls the same way, near (½, ½, 0.645); 2^20 cells
  // hold some that nearly do.
  float largest = 0.0f;
  for (int n = 0; n < (1 << 20); ++n)
    largest = std::max(largest, std::abs(shared::perlinNoise({n, n / 7, -n}, {0.5f, 0.5f, 0.6447f}, 0, 1u)));
  EXPECT_LE(largest, 1.0f);
  EXPECT_GT(largest, 0.8f);
}

TEST(Perlin, SlopeStaysUnderItsBound) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 0.999f);
  std::uniform_int_distribution<int> cell(-1000000, 1000000);
  constexpr float kStep = 1e-3f;
  double steepest = 0.0;
  for (int n = 0; n < 400000; ++n) {
    const glm::ivec3 c(cell(random), cell(random), cell(random));
    // Half of the places at the cell's centre, where the bound is reached.
    const glm::vec3 p =
        n % 2 ? glm::vec3(unit(random), unit(random), unit(random)) : glm::vec3(0.4995f, 0.5f, 0.5f);
    const float rise =
        shared::perlinNoise(c, p + glm::vec3(kStep, 0, 0), 0, 3u) - shared::perlinNoise(c, p, 0, 3u);
    steepest = std::max(steepest, std::abs(double(rise)) / double(kStep));
  }
  EXPECT_LE(steepest, kPerlinSlope * 1.001);
  EXPECT_GT(steepest, 0.6 * kPerlinSlope);
}

TEST(Perlin, MeanIsZeroWithinFourStandardErrors) {
  // One value a cell, at its centre: independent draws.
  double sum = 0.0, squares = 0.0;
  constexpr int kCount = 200000;
  for (int n = 0; n < kCount; ++n) {
    const double v = double(shared::perlinNoise({2 * n, 5 * n, -3 * n}, {0.5f, 0.5f, 0.5f}, 0, 11u));
    sum += v;
    squares += v * v;
  }
  const double deviation = std::sqrt(squares / kCount);
  EXPECT_LE(std::abs(sum / kCount), 4.0 * deviation / std::sqrt(double(kCount)));
  // At the centre each corner adds ± two of three halves: the sum of eight independent terms of mean square
  // ½, over 8² and scaled; the 16 choices repeat four edges, which leaves the mean square as it is.
  EXPECT_NEAR(deviation, double(shared::kPerlinScale) * std::sqrt(8.0 * 0.5) / 8.0, 0.01);
}

TEST(Perlin, RepeatsExactlyOverItsPeriod) {
  for (int period : {1, 2, 3, 7})
    for (int n = -20; n < 20; ++n) {
      const glm::vec3 f(0.3f, 0.6f, 0.9f);
      ASSERT_EQ(shared::perlinNoise({n, 2, -5}, f, period, 5u),
                shared::perlinNoise({n + period, 2 - period, -5}, f, period, 5u));
    }
}

TEST(Fbm, KeepsItsPrecisionFarFromTheOrigin) {
  // A period of 2^20 cells of ½ unit: 10 periods away the pattern must be the same.
  const FieldPtr field =
      makeField("fbm", {{"cell_size", 0.5}, {"octaves", int64_t{4}}, {"period", int64_t{1048576}}});
  for (int n = 0; n < 200; ++n) {
    const glm::dvec3 p(0.013 * n, 0.007 * n, 0.4);
    const glm::dvec3 far = p + glm::dvec3(10.0 * 1048576.0 * 0.5, 0.0, 0.0);
    ASSERT_NEAR(valueAt(*field, p), valueAt(*field, far), 1e-5f);
  }
}

TEST(Fbm, OctavesAreSeededApart) {
  // At the origin every octave of equal seed would be 0; with cells half a unit off they would all be alike.
  const auto octaves = fbmOctaves({1.0, 5, 2.0, 0.5, 0, 9u, {}, {}}, {0.001, 2, 0, nullptr}, "fbm");
  ASSERT_EQ(octaves.size(), 5u);
  for (size_t a = 0; a < octaves.size(); ++a)
    for (size_t b = 0; b < a; ++b) EXPECT_NE(octaves[a].seed, octaves[b].seed);
}

TEST(Fbm, WeightsAreThoseOfTheFormula) {
  const auto octaves = fbmOctaves({1.0, 3, 2.0, 0.5, 0, 0u, {}, {}}, {1e-4, 2, 0, nullptr}, "fbm");
  ASSERT_EQ(octaves.size(), 3u);
  EXPECT_FLOAT_EQ(octaves[0].weight, float(1.0 / 1.75));
  EXPECT_FLOAT_EQ(octaves[1].weight, float(0.5 / 1.75));
  EXPECT_FLOAT_EQ(octaves[2].weight, float(0.25 / 1.75));
  EXPECT_DOUBLE_EQ(octaves[2].cellSize, 0.25);
}

TEST(Fbm, LeavesOutWhatTheGridCannotHold) {
  std::vector<BandLimitNote> notes;
  const BuildContext context{0.1, 2, 0, &notes};  // cells of 1, ½, ¼, ⅛ unit are 10, 5, 2.5, 1.25 voxels
  const auto octaves = fbmOctaves({1.0, 4, 2.0, 0.5, 0, 0u, {}, {}}, context, "fbm");
  ASSERT_EQ(octaves.size(), 3u);
  EXPECT_FLOAT_EQ(octaves[2].weight, float(0.25 * 0.25 / 1.875));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_DOUBLE_EQ(notes[0].weight, 0.25);
  EXPECT_EQ(notes[1].octave, 3);
  EXPECT_EQ(notes[1].weight, 0.0);
}

TEST(Perlin, SlopeIsItsDerivative) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<float> unit(0.05f, 0.95f);
  for (int n = 0; n < 2000; ++n) {
    const glm::ivec3 cell(n, -n, 3 * n);
    const glm::vec3 f(unit(random), unit(random), unit(random));
    const glm::vec3 slope = shared::perlinSlope(cell, f, 0, 8u);
    constexpr float kStep = 0.01f;
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 ahead = f, behind = f;
      ahead[axis] += kStep;
      behind[axis] -= kStep;
      const float rise = shared::perlinNoise(cell, ahead, 0, 8u) - shared::perlinNoise(cell, behind, 0, 8u);
      // Central differences err by h²/6 of the third derivative, at most some 60 per cell³.
      ASSERT_NEAR(rise / (2.0f * kStep), slope[axis], 2e-3f);
    }
  }
}

TEST(Curl, HasNoSources) {
  std::array<FieldPtr, 3> flow;
  for (int axis = 0; axis < 3; ++axis)
    flow[size_t(axis)] = makeField("curl", {{"component", std::string(1, char('x' + axis))}});
  constexpr double kStep = 0.02;
  double largestSlope = 0.0;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 p(0.61 * n + 0.3, 0.37 * n + 0.4, -0.83 * n + 0.1);
    double divergence = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 d(0.0);
      d[axis] = kStep;
      const double slope =
          (double(valueAt(*flow[size_t(axis)], p + d)) - double(valueAt(*flow[size_t(axis)], p - d))) /
          (2.0 * kStep);
      divergence += slope;
      largestSlope = std::max(largestSlope, std::abs(slope));
    }
    ASSERT_NEAR(divergence, 0.0, 0.02) << "at " << n;
  }
  EXPECT_GT(largestSlope, 0.5);
}

TEST(Scroll, MovesThePatternWithTime) {
  const std::array<double, 3> speed{0.5, -0.25, 1.0};
  BuildContext later{0.01, 2, 0, nullptr, 3.0};
  for (const char* name : {"perlin", "fbm", "worley", "ridged", "value", "perlin_worley", "curl"}) {
    const FieldPtr start = makeField(name, {{"scroll", speed}});
    const FieldPtr moved = makeField(name, {{"scroll", speed}}, later);
    for (int n = 0; n < 50; ++n) {
      const glm::dvec3 p(0.11 * n, 0.23 * n, -0.31 * n);
      ASSERT_NEAR(valueAt(*start, p), valueAt(*moved, p + 3.0 * glm::dvec3(0.5, -0.25, 1.0)), 2e-5f) << name;
    }
  }
}

TEST(Scroll, FineOctavesMayMoveAlone) {
  const glm::dvec3 all(1.0, 0.0, 0.0), fine(0.0, 2.0, 0.0);
  const auto octaves = fbmOctaves({1.0, 3, 2.0, 0.5, 0, 0u, all, fine}, {1e-4, 2, 0, nullptr, 2.0}, "fbm");
  EXPECT_EQ(octaves[0].offset, 2.0 * all);
  EXPECT_EQ(octaves[1].offset, 2.0 * (all + 0.5 * fine));
  EXPECT_EQ(octaves[2].offset, 2.0 * (all + fine));
}

}  // namespace
}  // namespace nephele::test
