// The table of hard recipes: no density that is not finite, negative, outside its interval or elsewhere comes
// out of any; and what the map counts as wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bake/stability_page.h"

namespace nephele::test {
namespace {

const std::vector<BakeCase>& cases() {
  static const std::vector<BakeCase> all = bakeCases();
  return all;
}

TEST(BakeStability, NoCaseHoldsABadDensity) {
  size_t refused = 0;
  for (const BakeCase& on : cases()) {
    const std::string name = on.axis + " " + on.value;
    for (const BakeCell& cell : runCase(on, false)) {
      EXPECT_EQ(cell.bad.notFinite, 0u) << name;
      EXPECT_EQ(cell.bad.negative, 0u) << name;
      EXPECT_EQ(cell.bad.outsideBounds, 0u) << name;
      EXPECT_EQ(cell.bad.elsewhere, 0u) << name;
      EXPECT_TRUE(std::isfinite(cell.error.value_or(0.0))) << name;
      refused += cell.refused.empty() ? 0 : 1;
    }
  }
  EXPECT_LT(refused, cases().size() / 4);
}

TEST(BakeStability, EachCaseIsOneOfItsAxis) {
  std::set<std::string> names, closed;
  std::string axis;
  for (const BakeCase& on : cases()) {
    EXPECT_TRUE(names.insert(on.axis + " " + on.value).second) << on.axis << ' ' << on.value;
    if (on.axis != axis) {
      EXPECT_TRUE(closed.insert(on.axis).second) << "cases of '" << on.axis << "' are not together";
    }
    axis = on.axis;
  }
}

BakeCase ballOf(const std::string& radius) {
  BakeCase ball;
  ball.axis = "ball";
  ball.value = radius;
  ball.recipe =
      "assets: { a: { voxel_size: 1, precision: float, cutoff: 0, density: { sphere: { radius: " + radius +
      ", falloff: " + radius + " } } } }\n";
  ball.formula = [](const glm::dvec3& p) {
    return std::max(0.0, 1.0 - std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) / 10.0);
  };
  return ball;
}

TEST(BakeStability, VoxelsAreHeldAgainstTheirFormula) {
  EXPECT_LT(runCase(ballOf("10"), false).front().error.value_or(1.0), 1e-6);
  EXPECT_GT(runCase(ballOf("10.1"), false).front().error.value_or(0.0), kTrustedVoxels);
}

TEST(BakeStability, ATwinIsReadAboutTheOrigin) {
  BakeCase ball = ballOf("10");
  ball.twin = ball.recipe;
  ball.formula = nullptr;
  EXPECT_EQ(runCase(ball, false).front().error.value_or(1.0), 0.0);
  ball.middle = {1.0, 0.0, 0.0};
  EXPECT_GT(runCase(ball, false).front().error.value_or(0.0), 0.01);
}

TEST(BakeStability, WhatReachesBeyondTheCubeIsToldOf) {
  const BakeStability result{runCase(ballOf("20"), false), {}};
  ASSERT_EQ(badBakes(result).size(), 1u);
  EXPECT_NE(badBakes(result).front().find("voxels where none should be"), std::string::npos);
}

TEST(BakeStability, RefusalsKeepTheirSentence) {
  const BakeCell cell = runCase(ballOf("-1"), false).front();
  EXPECT_NE(cell.refused.find("'radius' of 'sphere' must be greater than 0"), std::string::npos)
      << cell.refused;
  EXPECT_FALSE(cell.error.has_value());
}

}  // namespace
}  // namespace nephele::test
