// Distributions, slopes and periods of all noises, with fixed seeds: against closed forms, against places
// drawn by another generator, and against the bounds that the fields declare.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "bake/fields/basis.h"
#include "bake/fields/shared_text.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

/// Independent places: random cells of a lattice of 2^32, random places in them.
struct Dice {
  std::mt19937_64 random;
  explicit Dice(uint64_t seed) : random(seed) {}
  glm::ivec3 cell() { return {int32_t(random()), int32_t(random()), int32_t(random())}; }
  float unit() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random); }
  glm::vec3 place() { return {unit(), unit(), unit()}; }
};

struct Moments {
  double mean = 0.0, square = 0.0, fourth = 0.0;
};
template <class Draw>
Moments momentsOf(int count, const Draw& draw) {
  Moments m;
  for (int n = 0; n < count; ++n) {
    const double v = double(draw());
    m.mean += v / count;
    m.square += v * v / count;
    m.fourth += v * v * v * v / count;
  }
  return m;
}

/// ∫ g over [0, 1] by the midpoint rule, far finer than the tests need.
template <class Function>
double integral(const Function& g) {
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int n = 0; n < kSteps; ++n) sum += g((n + 0.5) / kSteps) / kSteps;
  return sum;
}
double fadeOf(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

constexpr int kCount = 400000;
const double kErrors = 4.0 / std::sqrt(double(kCount));  // four standard errors of a unit deviation

TEST(PerlinStatistics, MeanAndVarianceAreThoseOfTheFormula) {
  Dice dice(1);
  const Moments m = momentsOf(kCount, [&] { return shared::perlinNoise(dice.cell(), dice.place(), 0, 5u); });
  // Eight corners with independent gradients of mean square 2 in all: 8 · 2 (∫ w²)² ∫ t² w², w = 1 − fade.
  const double w2 = integral([](double t) { return std::pow(1.0 - fadeOf(t), 2.0); });
  const double t2w2 = integral([](double t) { return std::pow(t * (1.0 - fadeOf(t)), 2.0); });
  const double scale = double(shared::kPerlinScale), variance = 16.0 * scale * scale * w2 * w2 * t2w2;
  EXPECT_NEAR(m.mean, 0.0, kErrors * std::sqrt(variance));
  EXPECT_NEAR(m.square, variance, kErrors * std::sqrt(m.fourth - variance * variance));
}

TEST(ValueStatistics, MeanAndVarianceAreThoseOfTheFormula) {
  Dice dice(2);
  const Moments m = momentsOf(kCount, [&] { return shared::valueNoise(dice.cell(), dice.place(), 0, 5u); });
  // Corners are even in [−1, 1], of variance 1/3; along an axis two weights meet.
  const double both =
      integral([](double t) { return std::pow(fadeOf(t), 2.0) + std::pow(1.0 - fadeOf(t), 2.0); });
  const double variance = both * both * both / 3.0;
  EXPECT_NEAR(m.mean, 0.0, kErrors * std::sqrt(variance));
  EXPECT_NEAR(m.square, variance, kErrors * std::sqrt(m.fourth - variance * variance));
}

TEST(BasisStatistics, MeansOfFoldedOctavesAreThoseDeclared) {
  for (const Basis basis : {Basis::perlin, Basis::value, Basis::worley}) {
    Dice dice(3);
    const NoiseOctave octave{1.0, 1.0f, 9u, 0};
    const auto draw = [&] {
      const float x = 0.0f;
      float value;
      const glm::dvec3 p = glm::dvec3(dice.cell()) + glm::dvec3(dice.place());
      evaluateBasis(basis, octave, Points{p, 1, &x, &x, &x}, &value);
      return value;
    };
    double plain = 0.0, magnitude = 0.0;
    for (int n = 0; n < kCount; ++n) {
      const double v = double(draw());
      plain += v / kCount;
      magnitude += std::abs(v) / kCount;
    }
    // Declared to 1e-3; deviations are below 0.5.
    const double room = 1e-3 + 0.5 * kErrors;
    EXPECT_NEAR(plain, meanOf(basis, Fold::plain), room) << int(basis);
    EXPECT_NEAR(magnitude, meanOf(basis, Fold::billow), room) << int(basis);
    EXPECT_NEAR(1.0 - magnitude, meanOf(basis, Fold::ridged), room) << int(basis);
  }
}

/// Nearest and second nearest of one point a cell, drawn by the standard library's generator.
std::array<double, 2> drawnDistances(Dice& dice, double jitter) {
  const glm::dvec3 p(dice.place());
  std::array<double, 2> nearest{9.0, 9.0};
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const glm::dvec3 d = glm::dvec3(x, y, z) + 0.5 + jitter * (glm::dvec3(dice.place()) - 0.5) - p;
        const double distance = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        nearest[1] = std::min(nearest[1], std::max(nearest[0], distance));
        nearest[0] = std::min(nearest[0], distance);
      }
  return nearest;
}

/// The largest difference of two samples' distribution functions [Kolmogorov and Smirnov].
double apart(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double largest = 0.0;
  for (size_t n = 0, m = 0; n < a.size(); ++n) {
    while (m < b.size() && b[m] <= a[n]) ++m;
    largest = std::max(largest, std::abs(double(n + 1) / double(a.size()) - double(m) / double(b.size())));
  }
  return largest;
}

TEST(WorleyStatistics, DistancesAreDistributedAsThoseOfDrawnPoints) {
  constexpr size_t kPlaces = 100000;
  // Level 1e-3 for each of the six comparisons: sqrt(ln(2 / 1e-3) / 2) = 1.9495.
  const double critical = 1.9495 * std::sqrt(2.0 / double(kPlaces));
  for (const float jitter : {1.0f, 0.5f}) {
    Dice dice(4);
    std::array<std::vector<double>, 3> ours, drawn;
    for (size_t n = 0; n < kPlaces; ++n) {
      const glm::vec2 d = shared::worleyDistances(dice.cell(), dice.place(), jitter, 0, 6u);
      const auto r = drawnDistances(dice, double(jitter));
      const double mine[3] = {double(d.x), double(d.y), double(d.y) - double(d.x)};
      const double other[3] = {r[0], r[1], r[1] - r[0]};
      for (size_t k = 0; k < 3; ++k) {
        ours[k].push_back(mine[k]);
        drawn[k].push_back(other[k]);
      }
    }
    for (size_t k = 0; k < 3; ++k)
      EXPECT_LT(apart(ours[k], drawn[k]), critical) << "output " << k << ", jitter " << jitter;
  }
}

/// The steepest of many steps of 1e-3 cells. `rise(cell, from, to)` is the value's change.
template <class Rise>
double steepest(const Rise& rise) {
  Dice dice(7);
  constexpr float kStep = 1e-3f;
  double most = 0.0;
  for (int n = 0; n < kCount; ++n) {
    glm::vec3 way(dice.unit() - 0.5f, dice.unit() - 0.5f, dice.unit() - 0.5f),
        from = 0.001f + 0.998f * dice.place();
    if (n % 2 == 0) {  // along an axis from the middle or an edge of a cell, where slopes are greatest
      way = glm::vec3(0.0f);
      way[n / 2 % 3] = 1.0f;
      from = n % 4 == 0 ? glm::vec3(0.5f) : glm::vec3(0.002f);
      from[n / 2 % 3] = 0.5f;
    }
    way *= kStep / std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
    const glm::vec3 to = glm::clamp(from + way, 0.0f, 0.9999f);
    const glm::dvec3 gone = glm::dvec3(to) - glm::dvec3(from);
    const double length = std::sqrt(gone.x * gone.x + gone.y * gone.y + gone.z * gone.z);
    if (length > 0.5 * double(kStep))
      most = std::max(most, std::abs(double(rise(dice.cell(), from, to))) / length);
  }
  return most;
}

TEST(Slopes, StayUnderTheirBoundsAndComeNear) {
  const auto hold = [](const char* what, double bound, const auto& value) {
    const double most = steepest([&](const glm::ivec3& cell, const glm::vec3& a, const glm::vec3& b) {
      return value(cell, b) - value(cell, a);
    });
    // Values are floats of at most √3: over a step of 1e-3 they round by 2.4e-4 of slope.
    EXPECT_LE(most, bound + 2.4e-4) << what;
    EXPECT_GT(most, 0.5 * bound) << what;
  };
  hold("perlin", kPerlinSlope,
       [](const glm::ivec3& c, const glm::vec3& p) { return shared::perlinNoise(c, p, 0, 3u); });
  hold("value", kValueSlope,
       [](const glm::ivec3& c, const glm::vec3& p) { return shared::valueNoise(c, p, 0, 3u); });
  const auto distances = [](const glm::ivec3& c, const glm::vec3& p) {
    return shared::worleyDistances(c, p, 1.0f, 0, 3u);
  };
  hold("f1", 1.0, [&](const glm::ivec3& c, const glm::vec3& p) { return distances(c, p).x; });
  hold("f2", 1.0, [&](const glm::ivec3& c, const glm::vec3& p) { return distances(c, p).y; });
  hold("f2 - f1", 2.0,
       [&](const glm::ivec3& c, const glm::vec3& p) { return distances(c, p).y - distances(c, p).x; });
}

TEST(Periods, RepeatBitByBitInEveryTileableRow) {
  int rows = 0;
  for (const FieldRow& row : fieldTable()) {
    if (std::none_of(row.parameters.begin(), row.parameters.end(),
                     [](const Parameter& p) { return p.name == "period"; }) ||
        row.name == "warp")  // its displacement repeats, but its input need not
      continue;
    ++rows;
    std::mt19937_64 random(8);
    std::uniform_int_distribution<int> place(-4096, 4096);
    for (const int64_t period : {1, 3, 8}) {
      // Cells of half a unit and places in 64ths: nothing is rounded on the way to a cell.
      const FieldPtr field = makeField(std::string(row.name), {{"cell_size", 0.5}, {"period", period}});
      for (int n = 0; n < 30; ++n) {
        const Lattice here{glm::dvec3(place(random), place(random), place(random)) / 64.0, 1.0 / 64.0};
        Lattice there = here;
        there.origin[n % 3] += double(n % 2 == 0 ? period : -5 * period) * 0.5;
        float a[kBlockPoints], b[kBlockPoints];
        field->evaluate(here, a);
        field->evaluate(there, b);
        ASSERT_EQ(std::memcmp(a, b, sizeof a), 0) << row.name << " on a block, period " << period;
        field->evaluate(LatticePoints(here).points(), a);
        field->evaluate(LatticePoints(there).points(), b);
        ASSERT_EQ(std::memcmp(a, b, sizeof a), 0) << row.name << " at points, period " << period;
      }
    }
  }
  EXPECT_GE(rows, 8);
}

TEST(Fbm, IsItsOctavesOverTheSumOfTheirWeights) {
  const double gain = 0.6;
  const FieldPtr field =
      makeField("fbm", {{"octaves", int64_t{3}}, {"gain", gain}, {"lacunarity", 2.0}}, {1e-3, 2, 0, nullptr});
  const auto octaves = fbmOctaves({1.0, 3, 2.0, gain, 0, shared::hashCell({0, 0, 0}, 0u), {}, {}},
                                  {1e-3, 2, 0, nullptr}, "fbm");
  Dice dice(9);
  for (int n = 0; n < 2000; ++n) {
    const glm::dvec3 p(10.0f * dice.place());
    double sum = 0.0, divisor = 0.0, weight = 1.0, frequency = 1.0;
    for (const NoiseOctave& octave : octaves) {
      const glm::dvec3 at = p * frequency, whole = glm::floor(at);
      sum += weight * double(shared::perlinNoise(glm::ivec3(whole), glm::vec3(at - whole), 0, octave.seed));
      divisor += weight;
      weight *= gain;
      frequency *= 2.0;
    }
    ASSERT_NEAR(valueAt(*field, p), sum / divisor, 4e-6);
  }
}

TEST(Fbm, OctavesFadeEvenlyBetweenFourAndTwoVoxels) {
  double last = 0.0;
  for (int n = 0; n <= 100; ++n) {
    const double voxels = 1.5 + 0.03 * n;  // to 4.5
    const FieldPtr field = makeField("perlin", {}, {1.0 / voxels, 2, 0, nullptr});
    const FieldPtr whole = makeField("perlin", {}, {1e-3, 2, 0, nullptr});
    const double expected = voxels >= 4.0 ? 1.0 : voxels <= 2.0 ? 0.0 : (voxels - 2.0) / 2.0;
    const glm::dvec3 p(0.31, 0.42, 0.77);
    ASSERT_NEAR(valueAt(*field, p), expected * double(valueAt(*whole, p)), 1e-6) << voxels;
    ASSERT_GE(expected, last);
    last = expected;
  }
}

}  // namespace
}  // namespace nephele::test
