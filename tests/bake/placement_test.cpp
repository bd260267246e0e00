// Fields read elsewhere: transforms, iterated warps, and what the band limit makes of cells that are too
// small.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/fields/turn.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

using Vector = std::array<double, 3>;

FieldPtr placed(const std::string& input, const Vector& scale, const Vector& rotate, const Vector& center,
                const Vector& translate) {
  return makeField("transform", {{"input", makeField(input)},
                                 {"scale", scale},
                                 {"rotate", rotate},
                                 {"center", center},
                                 {"translate", translate}});
}

TEST(Transform, PutsASphereWhereItsFormulaSays) {
  // Stretched to half axes 2, 1, ½, turned by 90° about z: 1, 2, ½, and moved.
  const FieldPtr field = placed("sphere", {2, 1, 0.5}, {0, 0, 90}, {0, 0, 0}, {5, 0, 0});
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 p(std::fmod(0.37 * n, 2.0) - 1.0, std::fmod(0.71 * n, 4.0) - 2.0,
                       std::fmod(0.13 * n, 1.0) - 0.5);
    const double r = std::sqrt(p.x * p.x + p.y * p.y / 4.0 + p.z * p.z * 4.0);
    ASSERT_NEAR(valueAt(*field, p + glm::dvec3(5, 0, 0)), std::max(0.0, 1.0 - r), 2e-6);
  }
  EXPECT_NEAR(field->support().high.x, 6.0, 1e-4);
  EXPECT_NEAR(field->support().low.y, -2.0, 1e-4);
}

TEST(Transform, LeavesItsCenterWhereItIs) {
  const FieldPtr field = placed("sphere", {3, 3, 3}, {20, 30, 40}, {0.5, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(valueAt(*field, {0.5, 0, 0}), 0.5f, 1e-6f);
}

TEST(Transform, TurnsFromXTowardsY) {
  // The plane's normal is x; a quarter turn about z makes it y.
  const FieldPtr ramp =
      makeField("linear", {{"direction", Vector{1, 0, 0}}, {"values", std::array<double, 2>{0, 1}}});
  const FieldPtr turned = makeField("transform", {{"input", ramp}, {"rotate", Vector{0, 0, 90}}});
  EXPECT_NEAR(valueAt(*turned, {0, 0.5, 0}), valueAt(*ramp, {0.5, 0, 0}), 1e-6f);
  EXPECT_NEAR(valueAt(*turned, {0.5, 0, 0}), valueAt(*ramp, {0, 0, 0}), 1e-6f);
}

/// Bounds, support and block against point, as for every row at its defaults.
void expectSound(const FieldPtr& field) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-3.0, 3.0), exponent(-2.5, 0.5);
  for (int b = 0; b < 1000; ++b) {
    const glm::dvec3 low(place(random), place(random), place(random));
    const double size = std::pow(10.0, exponent(random));
    const PointsInBox<64> points(random, glm::dvec3(size));
    float values[64];
    field->evaluate(points.from(low), values);
    const Interval bounds = field->bounds({low, low + size});
    for (int n = 0; n < 64; ++n) {
      ASSERT_TRUE(containsValue(bounds, double(values[n])));
      const glm::dvec3 p = low + glm::dvec3(double(points.x[n]), double(points.y[n]), double(points.z[n]));
      if (intersection(field->support(), Box{p, p}).empty()) {
        ASSERT_EQ(values[n], 0.0f);
      }
    }
    float block[kBlockPoints];
    field->evaluate(Lattice{low, 0.01}, block);
    for (int n = 0; n < kBlockPoints; n += 97)
      ASSERT_NEAR(block[n], valueAt(*field, low + 0.01 * glm::dvec3(n / 64, n / 8 % 8, n % 8)), 2e-5f);
  }
}

TEST(Transform, IsSoundForStretchedTurnedAndScaledFields) {
  expectSound(placed("sphere", {2, 0.7, 0.3}, {20, -50, 70}, {0.2, 0, -0.1}, {0.5, 0.1, 0}));
  expectSound(placed("fbm", {4, 1, 0.5}, {0, 0, 30}, {0, 0, 0}, {0, 0, 0}));
  expectSound(placed("perlin", {2, 2, 2}, {0, 0, 0}, {0, 0, 0}, {0.3, 0.1, 0}));
  expectSound(placed("plane", {2, 2, 0.5}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0.2}));
}

TEST(Warp, IterationsReadEachDisplacementWhereTheOneBeforeLeads) {
  // With linear inputs a warp gives its displaced coordinates; W₂ of two iterations is the second
  // displacement alone.
  const FieldPtr sphere = makeField("sphere");
  const auto warp = [&](int64_t iterations) {
    return makeField("warp", {{"input", sphere}, {"warp_scale", 0.4}, {"iterations", iterations}});
  };
  expectSound(warp(2));
  expectSound(warp(4));
  EXPECT_EQ(warp(3)->support().high.x, warp(1)->support().high.x);
  double apart = 0.0;
  for (int n = 0; n < 100; ++n) {
    const glm::dvec3 p(0.01 * n, -0.007 * n, 0.3);
    apart = std::max(apart, double(std::abs(valueAt(*warp(1), p) - valueAt(*warp(2), p))));
  }
  EXPECT_GT(apart, 0.1);
}

TEST(Warp, TellsHowMuchFinerItMakesItsInput) {
  std::vector<BandLimitNote> notes;
  const auto squeeze = [&](double scale, int64_t iterations) {
    notes.clear();
    makeField("warp",
              {{"input", makeField("sphere")},
               {"warp_scale", scale},
               {"octaves", int64_t{1}},
               {"iterations", iterations}},
              {0.01, 2, 0, &notes});
    return notes.back().squeeze;
  };
  EXPECT_EQ(squeeze(0.0, 1), 1.0);
  EXPECT_NEAR(squeeze(1.0, 1), std::sqrt(1.0 + 3.0 * 0.6794 * 0.6794), 1e-6);
  EXPECT_GT(squeeze(1.0, 2), squeeze(1.0, 1));
}

TEST(BandLimit, ThinShapesAreNoted) {
  const std::pair<const char*, std::map<std::string, Value, std::less<>>> shapes[] = {
      {"sphere", {{"radius", 0.009}}},
      {"ellipsoid", {{"radii", Vector{1, 1, 0.009}}}},
      {"box", {{"size", Vector{1, 0.018, 1}}, {"rounding", 0.0}}},
      {"capsule", {{"radius", 0.009}}},
      {"torus", {{"minor", 0.009}}}};
  for (const auto& [name, given] : shapes) {
    std::vector<BandLimitNote> notes;
    makeField(name, given, {0.01, 2, 0, &notes});
    ASSERT_EQ(notes.size(), 1u) << name;
    EXPECT_EQ(notes[0].field, name);
    EXPECT_NEAR(notes[0].thickness, 1.8, 1e-9) << name;
    notes.clear();
    makeField(name, given, {0.005, 2, 0, &notes});
    EXPECT_TRUE(notes.empty()) << name;
  }
}

TEST(BandLimit, LoneNoiseFadesToItsMean) {
  for (const char* const name : {"worley", "curl"}) {
    std::vector<BandLimitNote> notes;
    const auto at = [&](double voxel) { return makeField(name, {}, BuildContext{voxel, 2, 0, &notes}); };
    const FieldPtr whole = at(0.25), half = at(1.0 / 3.0), none = at(0.5);
    ASSERT_EQ(notes.size(), 2u) << name;
    EXPECT_NEAR(notes[0].weight, 0.5, 1e-12);
    EXPECT_EQ(notes[1].weight, 0.0);
    const float mean = valueAt(*none, {0.1, 0.2, 0.3});
    double sum = 0.0;
    constexpr int kPlaces = 20000;
    for (int n = 0; n < kPlaces; ++n) {
      const glm::dvec3 p(0.617 * n, 0.371 * n, -0.833 * n);
      const float v = valueAt(*whole, p);
      sum += double(v);
      ASSERT_NEAR(valueAt(*half, p), 0.5f * (v + mean), 1e-6f) << name;
      ASSERT_EQ(valueAt(*none, p), mean);
    }
    EXPECT_NEAR(sum / kPlaces, double(mean), 0.006) << name;
    expectSound(half);
  }
}

TEST(BandLimit, MeanDistanceFollowsJitterAndOutput) {
  for (const char* const output : {"f1", "f2", "f2_minus_f1"})
    for (const double jitter : {0.0, 0.4, 1.0}) {
      const std::map<std::string, Value, std::less<>> given{{"output", std::string(output)},
                                                            {"jitter", jitter}};
      const FieldPtr whole = makeField("worley", given),
                     none = makeField("worley", given, {1.0, 2, 0, nullptr});
      double sum = 0.0;
      constexpr int kPlaces = 20000;
      std::mt19937_64 random(5);
      std::uniform_real_distribution<double> place(-1000.0, 1000.0);
      for (int n = 0; n < kPlaces; ++n)
        sum += double(valueAt(*whole, {place(random), place(random), place(random)}));
      EXPECT_NEAR(sum / kPlaces, double(valueAt(*none, {0, 0, 0})), 0.006) << output << jitter;
    }
}

}  // namespace
}  // namespace nephele::test
