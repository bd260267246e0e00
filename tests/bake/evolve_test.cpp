// Noise that evolves: at rest it is the plain noise, it never leaves [−1, 1], its statistics do not change
// with time, and whole turns bring it back bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "bake/fields/motion.h"
#include "bake/fields/perlin.h"
#include "bake/fields/shared_text.h"
#include "bake/fields/worley_kernels.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

TEST(Turn, CosineAndSineAreThoseOfTheLibrary) {
  for (int n = -4000; n <= 4000; ++n) {
    const double turns = 0.00137 * n;
    const auto [cosine, sine] = cosineAndSine(turns);
    ASSERT_NEAR(cosine, std::cos(2.0 * std::numbers::pi * turns), 1e-14);
    ASSERT_NEAR(sine, std::sin(2.0 * std::numbers::pi * turns), 1e-14);
  }
  for (const double quarter : {-0.75, -0.5, 0.0, 0.25, 0.5, 1.75}) {
    const auto [cosine, sine] = cosineAndSine(quarter);
    EXPECT_EQ(std::abs(cosine) + std::abs(sine), 1.0);
  }
}

TEST(Turn, WholeTurnsLeaveNoTrace) {
  EXPECT_EQ(turnAt(0.375).at, turnAt(7.375).at);
  EXPECT_EQ(turnAt(-5.0).at, turnAt(0.0).at);
}

/// The largest |noise| before its scale over all turned gradients is Σ w_c √2 |d_c| in the best plane of each
/// corner c. True where that is certainly at most `limit` in the cube of edge `edge` at `low`; by symmetry
/// only x ≤ y ≤ z ≤ ½ counts.
bool largestIsBelow(double limit, const glm::dvec3& low, double edge, int depth) {
  if (low.x > low.y + edge || low.y > low.z + edge) return true;
  if (depth > 25) return false;
  double far[3][2], fade[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    far[axis][0] = (low[axis] + edge) * (low[axis] + edge);
    far[axis][1] = (1.0 - low[axis]) * (1.0 - low[axis]);
    for (int end = 0; end < 2; ++end) {
      const double t = low[axis] + end * edge;
      fade[axis][end] = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    }
  }
  double most[8];
  for (int c = 0; c < 8; ++c) {
    const double x = far[0][c & 1], y = far[1][c >> 1 & 1], z = far[2][c >> 2];
    most[c] = std::sqrt(2.0 * (x + y + z - std::min({x, y, z})));
  }
  // The mix is linear in each fade weight, so that it is largest at an end of each.
  double largest = 0.0;
  for (int end = 0; end < 8; ++end) {
    const double sx = fade[0][end & 1], sy = fade[1][end >> 1 & 1], sz = fade[2][end >> 2];
    const auto along = [](double a, double b, double t) { return a + t * (b - a); };
    largest =
        std::max(largest, along(along(along(most[0], most[1], sx), along(most[2], most[3], sx), sy),
                                along(along(most[4], most[5], sx), along(most[6], most[7], sx), sy), sz));
  }
  if (largest <= limit) return true;
  for (int octant = 0; octant < 8; ++octant)
    if (!largestIsBelow(limit, low + 0.5 * edge * glm::dvec3(octant & 1, octant >> 1 & 1, octant >> 2),
                        0.5 * edge, depth + 1))
      return false;
  return true;
}

TEST(TurningNoise, IsProvedToStayWithinOne) {
  EXPECT_TRUE(largestIsBelow(1.0386, glm::dvec3(0.0), 0.5, 0));
  EXPECT_LE(1.0386 * double(shared::kTurningScale), 1.0);
  EXPECT_FALSE(largestIsBelow(1.03, glm::dvec3(0.0), 0.5, 0)) << "the proof would accept what is not so";
}

TEST(TurningNoise, IsThePlainNoiseAtRestButForItsScale) {
  const Turn rest = turnAt(0.0);
  for (int n = 0; n < 1000; ++n) {
    const glm::vec3 f(0.001f * float(n), 0.3f, 0.7f);
    ASSERT_NEAR(shared::turningNoise({n, 3, -n}, f, 0, 7u, rest.at) / shared::kTurningScale,
                shared::perlinNoise({n, 3, -n}, f, 0, 7u) / shared::kPerlinScale, 1e-6f);
  }
}

TEST(TurningNoise, SlopeIsItsDerivativeAndStaysUnderItsBound) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<float> unit(0.05f, 0.95f);
  double steepest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const glm::ivec3 cell(n, -n, 3 * n);
    const glm::vec4 turn = turnAt(0.013 * n).at;
    const glm::vec3 f = n % 2 ? glm::vec3(unit(random), unit(random), unit(random)) : glm::vec3(0.5f);
    const glm::vec3 slope = shared::turningSlope(cell, f, 0, 8u, turn);
    steepest = std::max(steepest, double(glm::length(slope)));
    constexpr float kStep = 0.01f;
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 ahead = f, behind = f;
      ahead[axis] += kStep;
      behind[axis] -= kStep;
      const float rise =
          shared::turningNoise(cell, ahead, 0, 8u, turn) - shared::turningNoise(cell, behind, 0, 8u, turn);
      ASSERT_NEAR(rise / (2.0f * kStep), slope[axis], 2e-3f);
    }
  }
  EXPECT_LE(steepest, kPerlinSlope);
  EXPECT_GT(steepest, 0.5 * kPerlinSlope);
}

bool evolves(const FieldRow& row) {
  return std::any_of(row.parameters.begin(), row.parameters.end(),
                     [](const Parameter& parameter) { return parameter.name == "evolve"; });
}

/// Mean and mean square of one draw a cell at a random place.
template <class Noise>
std::pair<double, double> moments(const Noise& noise) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<float> unit(0.0f, 0.9999f);
  constexpr int kCount = 100000;
  double sum = 0.0, squares = 0.0;
  for (int n = 0; n < kCount; ++n) {
    const double v = double(noise({2 * n, 5 * n, -3 * n}, {unit(random), unit(random), unit(random)}));
    sum += v;
    squares += v * v;
  }
  return {sum / kCount, squares / kCount};
}

TEST(Evolving, StatisticsDoNotChangeWithTime) {
  const auto value = [](const glm::ivec3& c, const glm::vec3& f) { return shared::valueNoise(c, f, 0, 5u); };
  const auto distance = [](const glm::ivec3& c, const glm::vec3& f) {
    return shared::worleyDistances(c, f, 1.0f, 0, 5u).x;
  };
  const auto plain = [](const glm::ivec3& c, const glm::vec3& f) { return shared::perlinNoise(c, f, 0, 5u); };
  const auto [plainMean, plainSquare] = moments(plain);
  const auto [valueMean, valueSquare] = moments(value);
  const auto [distanceMean, distanceSquare] = moments(distance);
  const double scale = double(shared::kTurningScale / shared::kPerlinScale);
  for (const double turns : {0.1, 0.25, 0.5, 0.8}) {
    const glm::vec4 turn = turnAt(turns).at;
    // Standard errors are below 0.0013 for means and 0.0006 for mean squares; four of each, for both sides.
    const auto turning = moments(
        [&](const glm::ivec3& c, const glm::vec3& f) { return shared::turningNoise(c, f, 0, 5u, turn); });
    EXPECT_NEAR(turning.first, plainMean, 0.005);
    EXPECT_NEAR(turning.second, plainSquare * scale * scale, 0.0025);
    const auto values = moments(
        [&](const glm::ivec3& c, const glm::vec3& f) { return shared::turningValue(c, f, 0, 5u, turn); });
    EXPECT_NEAR(values.first, valueMean, 0.007);
    EXPECT_NEAR(values.second, valueSquare, 0.004);
    const auto distances = moments([&](const glm::ivec3& c, const glm::vec3& f) {
      return shared::movingDistances(c, f, 1.0f, 0, 5u, true, turn).x;
    });
    EXPECT_NEAR(distances.first, distanceMean, 0.003);
    EXPECT_NEAR(distances.second, distanceSquare, 0.003);
  }
}

TEST(Evolving, FeaturePointsStayInTheirCellsAndStartWhereTheyRest) {
  for (int n = 0; n < 20000; ++n) {
    const glm::ivec3 cell(n, 7 - n, n / 3);
    const glm::vec3 moved = shared::turnedFeature(cell, 1.0f, 0, 3u, turnAt(0.037 * n).at);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(moved[axis], -1e-6f);
      ASSERT_LE(moved[axis], 1.0f + 1e-6f);
      ASSERT_NEAR(shared::turnedFeature(cell, 1.0f, 0, 3u, turnAt(0.0).at)[axis],
                  shared::featurePoint(cell, 1.0f, 0, 3u)[axis], 1e-6f);
    }
  }
}

TEST(Evolving, EveryRowOfNoiseChangesInTimeAndNotWithoutIt) {
  const BuildContext later{0.01, 2, 0, nullptr, 0.7};
  int rows = 0;
  for (const FieldRow& row : fieldTable()) {
    if (!evolves(row)) continue;
    ++rows;
    const std::string name(row.name);
    const std::map<std::string, Value, std::less<>> evolving{{"evolve", 0.3}};
    const FieldPtr start = makeField(name, evolving), moved = makeField(name, evolving, later);
    const FieldPtr still = makeField(name), stillLater = makeField(name, {}, later);
    double change = 0.0;
    for (int n = 0; n < 200; ++n) {
      const glm::dvec3 p(0.011 * n, 0.023 * n, -0.031 * n);
      change = std::max(change, std::abs(double(valueAt(*start, p) - valueAt(*moved, p))));
      ASSERT_EQ(valueAt(*still, p), valueAt(*stillLater, p)) << name;
    }
    EXPECT_GT(change, 0.05) << name;
  }
  EXPECT_EQ(rows, 9);  // perlin, worley, perlin_worley, value, fbm, ridged, billow, warp, curl
}

TEST(Evolving, ChangesSmoothlyFromFrameToFrame) {
  const FieldPtr* previous = nullptr;
  FieldPtr held;
  for (int frame = 0; frame <= 48; ++frame) {
    const FieldPtr now = makeField("fbm", {{"evolve", 0.5}}, {0.01, 2, 0, nullptr, frame / 24.0});
    if (previous)
      for (int n = 0; n < 100; ++n) {
        const glm::dvec3 p(0.11 * n, 0.23 * n, -0.31 * n);
        // The fifth octave turns 2^(8/3) · ½ times a second, half of it twice as fast: a quarter turn a
        // frame.
        ASSERT_NEAR(valueAt(*held, p), valueAt(*now, p), 0.35f) << frame;
      }
    held = now;
    previous = &held;
  }
}

TEST(Evolving, FinerOctavesTurnFasterByTwoThirdsOfTheirFineness) {
  EXPECT_DOUBLE_EQ(evolveRate(8.0, 1), 4.0);
  EXPECT_NEAR(evolveRate(2.0, 3), 4.0, 1e-14);
  EXPECT_EQ(evolveRate(1.0, 5), 1.0);
  EXPECT_EQ(evolveRate(3.0, 0), 1.0);
}

TEST(Loop, EveryRowComesRoundBitForBit) {
  for (const FieldRow& row : fieldTable()) {
    if (!evolves(row)) continue;
    const std::string name(row.name);
    std::map<std::string, Value, std::less<>> moving{{"evolve", 0.61}};
    for (const Parameter& parameter : row.parameters) {
      if (parameter.name == "period") moving.emplace("period", int64_t{3});
      if (parameter.name == "scroll") moving.emplace("scroll", std::array<double, 3>{1.7, -3.1, 0.0});
      if (parameter.name == "fine_scroll")
        moving.emplace("fine_scroll", std::array<double, 3>{0.0, 2.2, -0.9});
    }
    constexpr int64_t kFrames = 97;
    const auto at = [&](int64_t frame) {
      return makeField(
          name, moving,
          BuildContext{0.01, 2, 0, nullptr, double(frame) / 23.976, Loop{kFrames, frame, 23.976}});
    };
    const FieldPtr start = at(5), after = at(5 + kFrames), late = at(5 + 1000 * kFrames), between = at(6);
    int changed = 0;
    for (int n = 0; n < 300; ++n) {
      const glm::dvec3 p(0.011 * n, 0.023 * n, -0.031 * n);
      ASSERT_EQ(valueAt(*start, p), valueAt(*after, p)) << name;
      ASSERT_EQ(valueAt(*start, p), valueAt(*late, p)) << name;
      changed += valueAt(*start, p) != valueAt(*between, p);
    }
    EXPECT_GT(changed, 150) << name;
  }
}

TEST(Loop, TakesTheNearestMotionThatCloses) {
  // 48 frames at 24 are two seconds; a period of 4 cells of ½ is two world units.
  const Motion motion{2.0, {0.9, -2.4, 0.0}, {0.0, 0.0, 3.0}, 0.8, 4, 2.0};
  const Loop loop{48, 12, 24.0};
  const BuildContext context{0.01, 2, 0, nullptr, 0.5, loop};
  EXPECT_EQ(octavePlace(motion, 0, context).offset,
            glm::dvec3(0.25 * 2.0, 0.5 * 2.0, 0.0));                   // 1, −2, 0 periods
  EXPECT_EQ(octavePlace(motion, 3, context).offset.z, 0.75 * 2.0);     // 3 periods
  EXPECT_EQ(octavePlace(motion, 0, context).turn.at, turnAt(0.5).at);  // 2 turns
  EXPECT_EQ(meanScroll(motion, context), glm::dvec3(1.0, -2.0, 1.5));
  ASSERT_EQ(loopNotes(motion, loop, "fbm").size(), 2u);
  EXPECT_EQ(loopNotes(motion, loop, "fbm")[0].used, "[1, -2, 0]");
  EXPECT_EQ(loopNotes(motion, loop, "fbm")[1].used, "1");
}

TEST(Evolving, BoundsContainEveryValue) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const FieldRow& row : fieldTable()) {
    if (!evolves(row)) continue;
    const FieldPtr field =
        makeField(std::string(row.name), {{"evolve", 0.3}}, BuildContext{0.01, 2, 0, nullptr, 1.3});
    for (int b = 0; b < 600; ++b) {
      const glm::dvec3 low(3.0 * unit(random), -2.0 * unit(random), unit(random));
      const double size = std::pow(10.0, -3.0 * unit(random));
      const PointsInBox<64> points(random, glm::dvec3(size));
      float values[64];
      field->evaluate(points.from(low), values);
      const Interval bounds = field->bounds({low, low + size});
      for (const float v : values) ASSERT_TRUE(containsValue(bounds, double(v))) << row.name;
    }
  }
}

}  // namespace
}  // namespace nephele::test
