// Shapes, set operations and ramps against their formulas, MODEL.md section 1.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/fields/shared_text.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

using Vector = std::array<double, 3>;

FieldPtr constant(double value) { return makeField("constant", {{"value", value}}); }

TEST(Shapes, DistancesAtKnownPoints) {
  using glm::vec3;
  // A box of 2 × 4 × 6: outside beside a face, an edge and a corner, inside nearest to x.
  const vec3 half(1.0f, 2.0f, 3.0f);
  EXPECT_FLOAT_EQ(shared::distanceToBox(vec3(3, 0, 0), half, 0.0f), 2.0f);
  EXPECT_FLOAT_EQ(shared::distanceToBox(vec3(4, 6, 0), half, 0.0f), 5.0f);
  EXPECT_FLOAT_EQ(shared::distanceToBox(vec3(2, 4, 5), half, 0.0f), 3.0f);
  EXPECT_FLOAT_EQ(shared::distanceToBox(vec3(0.25f, 0.5f, 0), half, 0.0f), -0.75f);
  // Rounding takes the corner away: √3 · ½ of it.
  EXPECT_NEAR(shared::distanceToBox(vec3(1, 2, 3), half, 0.5f), 0.5f * (std::sqrt(3.0f) - 1.0f), 1e-6f);
  EXPECT_FLOAT_EQ(shared::distanceToCapsule(vec3(5, 3, 0), vec3(2, 0, 0), 1.0f), std::sqrt(18.0f) - 1.0f);
  EXPECT_FLOAT_EQ(shared::distanceToCapsule(vec3(1, 0, 3), vec3(2, 0, 0), 1.0f), 2.0f);
  EXPECT_FLOAT_EQ(shared::distanceToCapsule(vec3(0, 4, 3), vec3(0, 0, 0), 1.0f), 4.0f);
  EXPECT_FLOAT_EQ(shared::distanceToTorus(vec3(5, 0, 4), vec3(0, 0, 1), 2.0f, 1.0f), 4.0f);
  EXPECT_FLOAT_EQ(shared::distanceToTorus(vec3(0, 0, 0), vec3(0, 1, 0), 2.0f, 0.5f), 1.5f);
  EXPECT_FLOAT_EQ(shared::distanceToPlane(vec3(1, 2, 3), vec3(0, 0, -1)), -3.0f);
  EXPECT_FLOAT_EQ(shared::distanceToEllipsoid(vec3(0, 0, 0), vec3(3, 2, 1), 1.0f), -1.0f);
  EXPECT_FLOAT_EQ(shared::distanceToEllipsoid(vec3(0, 4, 0), vec3(3, 2, 1), 1.0f), 1.0f);
  EXPECT_FLOAT_EQ(shared::distanceToEllipsoid(vec3(0, 0, 3), vec3(3, 2, 1), 1.0f), 2.0f);
}

TEST(Shapes, NoDistanceChangesByMoreThanTheStep) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> place(-2.0f, 2.0f);
  const auto point = [&] { return glm::vec3(place(random), place(random), place(random)); };
  const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -2));
  double steepest[5] = {};
  for (int n = 0; n < 200000; ++n) {
    const glm::vec3 p = point(), q = p + 0.05f * point();
    const double apart = double(glm::length(p - q));
    const auto watch = [&](int shape, float a, float b) {
      steepest[shape] = std::max(steepest[shape], (std::abs(double(a) - double(b)) - 1e-6) / apart);
    };
    const auto ellipsoid = [](const glm::vec3& v) {
      return shared::distanceToEllipsoid(v, glm::vec3(1.5f, 0.2f, 0.9f), 0.2f);
    };
    const auto box = [](const glm::vec3& v) {
      return shared::distanceToBox(v, glm::vec3(1, 0.5f, 0.2f), 0.1f);
    };
    const auto capsule = [](const glm::vec3& v) {
      return shared::distanceToCapsule(v, glm::vec3(0.5f, 1, 0), 0.3f);
    };
    const auto torus = [&](const glm::vec3& v) { return shared::distanceToTorus(v, axis, 1.0f, 0.3f); };
    const auto plane = [&](const glm::vec3& v) { return shared::distanceToPlane(v, axis); };
    watch(0, ellipsoid(p), ellipsoid(q));
    watch(1, box(p), box(q));
    watch(2, capsule(p), capsule(q));
    watch(3, torus(p), torus(q));
    watch(4, plane(p), plane(q));
  }
  for (const double slope : steepest) {
    EXPECT_LE(slope, 1.0);
    EXPECT_GT(slope, 0.99) << "the bound is never used up";
  }
}

TEST(Shapes, TheEllipsoidsDistanceIsALowerBound) {
  // The true distance, by trying points of the surface.
  const glm::vec3 radii(1.5f, 0.5f, 0.8f);
  std::mt19937_64 random(6);
  std::normal_distribution<float> place(0.0f, 1.0f);
  std::vector<glm::vec3> surface;
  for (int n = 0; n < 20000; ++n)
    surface.push_back(glm::normalize(glm::vec3(place(random), place(random), place(random))) * radii);
  for (int n = 0; n < 200; ++n) {
    const glm::vec3 p(place(random), place(random), place(random));
    float truth = 1e9f;
    for (const glm::vec3& q : surface) truth = std::min(truth, glm::length(p - q));
    const float bound = shared::distanceToEllipsoid(p, radii, 0.5f);
    EXPECT_EQ(bound < 0.0f, glm::length(p / radii) < 1.0f);
    EXPECT_LE(std::abs(bound), truth + 1e-6f);
  }
}

TEST(Shapes, StandWhereTheyArePutAlsoFarAway) {
  const Vector far{1e7, -1e7, 1e7};
  const glm::dvec3 at(1e7, -1e7, 1e7);
  const FieldPtr ellipsoid =
      makeField("ellipsoid", {{"center", far}, {"radii", Vector{2, 1, 0.5}}, {"falloff", 0.5}});
  EXPECT_NEAR(valueAt(*ellipsoid, at + glm::dvec3(0.5, 0, 0)), 0.75, 1e-6);
  const FieldPtr box =
      makeField("box", {{"center", far}, {"size", Vector{2, 2, 2}}, {"rounding", 0.0}, {"falloff", 1.0}});
  EXPECT_NEAR(valueAt(*box, at + glm::dvec3(0, -0.75, 0.25)), 0.25, 1e-6);
  EXPECT_EQ(valueAt(*box, at + glm::dvec3(0, 1, 0)), 0.0f);
  const FieldPtr capsule = makeField(
      "capsule", {{"from", far}, {"to", Vector{1e7 + 2, -1e7, 1e7}}, {"radius", 1.0}, {"falloff", 1.0}});
  EXPECT_NEAR(valueAt(*capsule, at + glm::dvec3(1, 0.25, 0)), 0.75, 1e-6);
  const FieldPtr torus =
      makeField("torus", {{"center", far}, {"major", 2.0}, {"minor", 1.0}, {"falloff", 1.0}});
  EXPECT_NEAR(valueAt(*torus, at + glm::dvec3(0, 2, 0.25)), 0.75, 1e-6);
  EXPECT_EQ(valueAt(*torus, at), 0.0f);
  const FieldPtr plane = makeField("plane", {{"point", far}, {"normal", Vector{0, 3, 4}}, {"falloff", 1.0}});
  EXPECT_NEAR(valueAt(*plane, at - glm::dvec3(7, 0.3, 0.4)), 0.5, 1e-6);
  EXPECT_EQ(valueAt(*plane, at + glm::dvec3(7, 0.3, 0.4)), 0.0f);
}

TEST(Shapes, TheRingAndThePlaneFollowTheUpAxis) {
  const BuildContext upY{0.01, 1, 0, nullptr};
  EXPECT_GT(valueAt(*makeField("torus", {}, upY), {0, 0, 0.7}), 0.9f);
  EXPECT_EQ(valueAt(*makeField("torus", {}, upY), {0, 0.7, 0}), 0.0f);
  EXPECT_EQ(valueAt(*makeField("plane", {}, upY), {0, -1, 1}), 1.0f);
  EXPECT_EQ(makeField("plane", {}, upY)->support().high.y, 0.0);
}

FieldPtr folded(const char* name, const std::vector<double>& values,
                std::map<std::string, Value, std::less<>> given = {}) {
  std::vector<FieldPtr> inputs;
  for (const double v : values) inputs.push_back(constant(v));
  given.emplace("inputs", inputs);
  return makeField(name, std::move(given));
}
double fold(const char* name, const std::vector<double>& values) {
  return double(valueAt(*folded(name, values), {0, 0, 0}));
}

TEST(SetOperations, AreThoseOfSetsOnZeroAndOne) {
  for (const double a : {0.0, 1.0})
    for (const double b : {0.0, 1.0}) {
      EXPECT_EQ(fold("union", {a, b}), a + b > 0.0 ? 1.0 : 0.0);
      EXPECT_EQ(fold("smooth_union", {a, b}), a + b > 0.0 ? 1.0 : 0.0);
      EXPECT_EQ(fold("intersection", {a, b}), a * b);
      EXPECT_EQ(fold("difference", {a, b}), a * (1.0 - b));
    }
}

TEST(SetOperations, ObeyTheLawsOfFuzzySets) {
  const double shares[] = {0.0, 0.25, 0.375, 0.5, 0.875, 1.0};  // exact in floats
  for (const double a : shares)
    for (const double b : shares) {
      // De Morgan: not (a or b) = not a and not b.
      EXPECT_EQ(1.0 - fold("union", {a, b}), fold("intersection", {1.0 - a, 1.0 - b}));
      EXPECT_EQ(fold("difference", {1.0, fold("intersection", {a, b})}),
                fold("union", {fold("difference", {1.0, a}), fold("difference", {1.0, b})}));
      EXPECT_EQ(fold("union", {a, a}), a);
      EXPECT_EQ(fold("intersection", {a, a}), a);
      EXPECT_EQ(fold("difference", {a, b}), std::min(a, 1.0 - b));
    }
  EXPECT_EQ(fold("difference", {1.0, 0.25, 0.5}), 0.5);
  EXPECT_EQ(fold("union", {-3.0, -1.0}), 0.0);
  EXPECT_EQ(fold("intersection", {-3.0, 1.0}), 0.0);
  EXPECT_EQ(fold("difference", {-3.0, 0.0}), 0.0);
  EXPECT_EQ(fold("difference", {2.0, -3.0}), 2.0) << "what is negative takes nothing away and adds nothing";
  EXPECT_EQ(fold("difference", {2.5, 0.0}), 2.5) << "where nothing is taken away, density above 1 stays";
  EXPECT_EQ(fold("difference", {2.5, 1.0}), 0.0);
  EXPECT_EQ(fold("difference", {2.5, 0.25}), 1.875) << "the complement in a set of density 2.5";
  EXPECT_EQ(fold("difference", {0.5, 7.0}), 0.0) << "a density above 1 takes away all, not more";
}

TEST(SetOperations, SmoothUnionIsQuilezsWhereBothAreThick) {
  for (const double k : {0.1, 0.3})
    for (const double a : {0.5, 0.55, 0.6, 0.9})
      for (const double b : {0.5, 0.52, 0.62, 0.8}) {
        const double h = std::max(k - std::abs(a - b), 0.0) / k;
        const double value = double(valueAt(*folded("smooth_union", {a, b}, {{"blend", k}}), {0, 0, 0}));
        EXPECT_NEAR(value, std::min(std::max(a, b) + h * h * k / 4.0, 1.0), 1e-6);
      }
}

TEST(SetOperations, SmoothUnionIsNeverBelowItsInputsAndEndsWithThem) {
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) {
      const float a = float(i) / 40.0f, b = float(j) / 40.0f;
      const float v = shared::uniteSmoothly(a, b, 0.5f);
      EXPECT_GE(v, std::max(a, b));
      EXPECT_LE(v, 1.0f);
      EXPECT_EQ(v, shared::uniteSmoothly(b, a, 0.5f));
      // It grows with both, which its bounds rely on.
      EXPECT_LE(v, shared::uniteSmoothly(a + 1e-3f, b, 0.5f));
      EXPECT_LE(v, shared::uniteSmoothly(a, b + 1e-3f, 0.5f));
      EXPECT_TRUE(i > 0 || v == b);
    }
  EXPECT_EQ(shared::uniteSmoothly(0.3f, 0.3f, 0.0f), 0.3f);
}

TEST(SetOperations, EndWhereTheirInputsEnd) {
  const FieldPtr left = makeField("sphere", {{"center", Vector{-1, 0, 0}}}),
                 right = makeField("sphere", {{"center", Vector{0.5, 0, 0}}});
  const auto support = [&](const char* name) {
    return makeField(name, {{"inputs", std::vector<FieldPtr>{left, right}}})->support();
  };
  EXPECT_NEAR(support("union").high.x, 1.5, 1e-5);
  EXPECT_NEAR(support("smooth_union").low.x, -2.0, 1e-5);
  EXPECT_NEAR(support("intersection").low.x, -0.5, 1e-5);
  EXPECT_NEAR(support("difference").high.x, 0.0, 1e-5);
}

TEST(Exponential, FunctionAgreesWithDoubleEverywhere) {
  double worst = 0.0;
  for (int n = 0; n <= 1750000; ++n) {
    const float x = -87.0f + 1e-4f * float(n);
    if (x > 88.0f) break;
    const double truth = std::exp(double(x));
    worst = std::max(worst, std::abs(double(shared::exponential(x)) - truth) / truth);
  }
  EXPECT_LT(worst, 3e-7);
  EXPECT_GT(worst, 1e-9);
  EXPECT_EQ(shared::exponential(0.0f), 1.0f);
  EXPECT_EQ(shared::exponential(-0.0f), 1.0f);
  EXPECT_EQ(shared::exponential(-87.5f), 0.0f);
  EXPECT_EQ(shared::exponential(-INFINITY), 0.0f);
  EXPECT_EQ(shared::exponential(89.0f), INFINITY);
  EXPECT_TRUE(std::isnan(shared::exponential(NAN)));
}

TEST(Exponential, ThinsOutByItsScaleHeight) {
  const FieldPtr field = makeField("exponential", {{"base", 10.0}, {"value", 3.0}, {"scale_height", 2.0}});
  for (const double z : {10.0, 10.5, 12.0, 20.0, 60.0})
    EXPECT_NEAR(valueAt(*field, {5, -7, z}), 3.0 * std::exp(-(z - 10.0) / 2.0), 3e-6);
  EXPECT_EQ(valueAt(*field, {0, 0, 9.0}), 3.0f);
  EXPECT_EQ(valueAt(*field, {0, 0, 10.0 + 2.0 * 87.1}), 0.0f);
  EXPECT_LT(field->support().high.z, 10.0 + 2.0 * 87.1);
  const FieldPtr cut = makeField("exponential", {{"base", 10.0}, {"below", std::string("nothing")}});
  EXPECT_EQ(valueAt(*cut, {0, 0, 9.99}), 0.0f);
  EXPECT_NEAR(cut->support().low.z, 10.0, 1e-4);
}

TEST(Linear, RunsFromOneValueToAnotherAndStaysThere) {
  const FieldPtr field =
      makeField("linear", {{"from", 2.0}, {"to", 6.0}, {"values", std::array<double, 2>{0.3, 0.1}}});
  EXPECT_EQ(valueAt(*field, {9, 9, -100}), 0.3f);
  EXPECT_EQ(valueAt(*field, {9, 9, 100}), 0.1f);
  EXPECT_NEAR(valueAt(*field, {0, 0, 3}), 0.25, 1e-7);
  const FieldPtr aslant = makeField(
      "linear",
      {{"from", 0.0}, {"to", 5.0}, {"values", std::array<double, 2>{0, 1}}, {"direction", Vector{3, 4, 0}}});
  EXPECT_NEAR(valueAt(*aslant, {3, 0, 77}), 1.8 / 5.0, 1e-6);
  EXPECT_NEAR(valueAt(*makeField("linear", {}, {0.01, 1, 0, nullptr}), {0, 0.5, 9}), 0.25, 1e-7);
  // Reversed heights are legal: 0 at 1, growing downwards, so it ends at 1.
  const FieldPtr down =
      makeField("linear", {{"from", 1.0}, {"to", -1.0}, {"values", std::array<double, 2>{0, 1}}});
  EXPECT_NEAR(valueAt(*down, {0, 0, 0.5}), 0.25, 1e-7);
  EXPECT_NEAR(down->support().high.z, 1.0, 1e-5);
  EXPECT_EQ(down->support().low.z, -INFINITY);
  const Interval bounds = down->bounds({{0, 0, 0}, {1, 1, 0.5}});
  EXPECT_NEAR(bounds.low, 0.25, 1e-5);
  EXPECT_NEAR(bounds.high, 0.5, 1e-5);
}

}  // namespace
}  // namespace nephele::test
