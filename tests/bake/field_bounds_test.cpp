// Properties that every row of the field table must have: bounds contain, support contains, blocks agree with
// points.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

/// Boxes of all sizes near the origin: 10^-3 … 10^1 across, within 3 of it.
Box randomBox(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-2.0, 2.0), exponent(-3.0, 1.0), share(0.1, 1.0);
  const glm::dvec3 centre(place(random), place(random), place(random));
  const double size = std::pow(10.0, exponent(random));
  const glm::dvec3 half = 0.5 * size * glm::dvec3(share(random), share(random), share(random));
  return {centre - half, centre + half};
}

class EveryField : public testing::TestWithParam<std::string> {};

TEST_P(EveryField, BoundsContainEveryValue) {
  const FieldPtr field = makeField(GetParam());
  std::mt19937_64 random(1);
  constexpr int kBoxes = 4000, kPoints = 250;  // a million points a field
  float values[kPoints];
  int tight = 0;
  for (int b = 0; b < kBoxes; ++b) {
    const Box box = randomBox(random);
    const PointsInBox<kPoints> points(random, box.high - box.low);
    field->evaluate(points.from(box.low), values);
    const Interval bounds = field->bounds(box);
    ASSERT_LE(bounds.low, bounds.high);
    float low = values[0], high = values[0];
    for (const float v : values) {
      ASSERT_TRUE(containsValue(bounds, double(v)))
          << v << " outside [" << bounds.low << ", " << bounds.high << "]";
      low = std::min(low, v);
      high = std::max(high, v);
    }
    tight += bounds.high - bounds.low <= 10.0 * double(high - low) + 1e-4;
  }
  // Bounds that were infinite everywhere would pass the test above and cull nothing.
  EXPECT_GT(tight, kBoxes / 4) << "bounds are rarely within ten times the values' own range";
}

TEST_P(EveryField, ValuesOutsideTheSupportAreZero) {
  const FieldPtr field = makeField(GetParam());
  const Box support = field->support();
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 p(place(random), place(random), place(random));
    if (!intersection(support, Box{p, p}).empty()) continue;
    ASSERT_EQ(valueAt(*field, p), 0.0f) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST_P(EveryField, BlocksAgreeWithPoints) {
  const FieldPtr field = makeField(GetParam());
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  float largest = 0.0f;
  for (int b = 0; b < 300; ++b) {
    const Lattice lattice{{place(random), place(random), place(random)}, 0.01};
    float values[kBlockPoints];
    field->evaluate(lattice, values);
    for (int n = 0; n < kBlockPoints; n += 37) {
      const glm::dvec3 p = lattice.origin + 0.01 * glm::dvec3(n / 64, n / 8 % 8, n % 8);
      largest = std::max(largest, std::abs(values[n] - valueAt(*field, p)));
    }
  }
  // Coordinates on a block are floats relative to its corner; slopes here stay below 100 per unit.
  EXPECT_LE(largest, 2e-5f);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryField, testing::ValuesIn(fieldNames()),
                         [](const auto& row) { return row.param; });

TEST(Box, HullAndIntersectionTreatEmptyOnesRightly) {
  const Box unit{glm::dvec3(0.0), glm::dvec3(1.0)};
  EXPECT_TRUE(nothing().empty());
  EXPECT_TRUE(intersection(unit, nothing()).empty());
  EXPECT_EQ(hull(unit, nothing()).high, unit.high);
  EXPECT_TRUE(intersection(unit, {glm::dvec3(2.0), glm::dvec3(3.0)}).empty());
}

}  // namespace
}  // namespace nephele::test
