// Fields against their formulas, MODEL.md section 1.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/fields/noise_kernels.h"
#include "bake/fields/perlin.h"
#include "bake/fields/shared_text.h"
#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

TEST(Sphere, FallsLinearlyFromItsCentre) {
  const FieldPtr field =
      makeField("sphere", {{"center", std::array<double, 3>{1, 2, 3}}, {"radius", 2.0}, {"falloff", 2.0}});
  for (int n = 0; n <= 30; ++n) {
    const double d = 0.1 * n;
    EXPECT_NEAR(valueAt(*field, {1.0 + d * 0.6, 2.0, 3.0 - d * 0.8}), std::max(0.0, 1.0 - d / 2.0), 1e-6);
  }
}

TEST(Sphere, IsAsPreciseFarAway) {
  const FieldPtr field = makeField("sphere", {{"center", std::array<double, 3>{1e7, -1e7, 1e7}}});
  EXPECT_NEAR(valueAt(*field, {1e7 + 0.25, -1e7, 1e7}), 0.75, 1e-6);
}

TEST(Sphere, WithoutFalloffIsAHardEdge) {
  const FieldPtr field = makeField("sphere", {{"falloff", 0.0}});
  EXPECT_EQ(valueAt(*field, {0.999, 0, 0}), 1.0f);
  EXPECT_EQ(valueAt(*field, {1.0, 0, 0}), 0.0f);
}

TEST(HeightProfile, IsTheReportsRemapByDefault) {
  const FieldPtr field = makeField("height_profile");
  for (int n = -30; n <= 30; ++n) {
    const double z = 0.05 * n;
    const double height = (z + 1.0) / 2.0;
    const float expected = shared::remapRange(float(height), 0.5f, 1.0f, 0.0f, 1.0f);
    EXPECT_NEAR(valueAt(*field, {0.3, -0.2, z}), expected, 1e-6);
  }
}

TEST(HeightProfile, RunsAlongTheRecipesUpAxis) {
  const FieldPtr upY = makeField("height_profile", {}, {0.01, 1, 0, nullptr});
  EXPECT_EQ(valueAt(*upY, {0.0, 1.0, 0.0}), 1.0f);
  EXPECT_EQ(valueAt(*upY, {0.0, -1.0, 1.0}), 0.0f);
}

TEST(Remap, ClampsAndStretchesAlsoReversed) {
  EXPECT_FLOAT_EQ(shared::remapRange(0.25f, 0.0f, 0.5f, 10.0f, 20.0f), 15.0f);
  EXPECT_FLOAT_EQ(shared::remapRange(9.0f, 0.0f, 0.5f, 10.0f, 20.0f), 20.0f);
  EXPECT_FLOAT_EQ(shared::remapRange(0.9f, 1.0f, 0.5f, 0.0f, 1.0f), 0.2f);
  EXPECT_FLOAT_EQ(shared::remapRange(2.0f, 1.0f, 0.5f, 0.0f, 1.0f), 0.0f);
}

TEST(Combine, FoldsItsInputs) {
  const std::vector<FieldPtr> inputs{makeField("constant", {{"value", 3.0}}),
                                     makeField("constant", {{"value", -2.0}}),
                                     makeField("constant", {{"value", 0.5}})};
  const auto fold = [&](const char* name) {
    return valueAt(*makeField(name, {{"inputs", inputs}}), {0, 0, 0});
  };
  EXPECT_EQ(fold("add"), 1.5f);
  EXPECT_EQ(fold("multiply"), -3.0f);
  EXPECT_EQ(fold("min"), -2.0f);
  EXPECT_EQ(fold("max"), 3.0f);
}

TEST(Mix, IsLinearInItsWeight) {
  const auto constant = [](double v) { return makeField("constant", {{"value", v}}); };
  const FieldPtr field =
      makeField("mix", {{"a", constant(2.0)}, {"b", constant(6.0)}, {"t", constant(0.25)}});
  EXPECT_EQ(valueAt(*field, {0, 0, 0}), 3.0f);
}

/// The report's sphere in four steps, from table rows: {envelope · (0.8 fBm + ½), that warped, that cut by
/// height}.
struct ReportSphere {
  FieldPtr fbm = makeField("fbm", {{"cell_size", 0.4}});
  FieldPtr inner, warped, cloud;

  ReportSphere() {
    const auto list = [](FieldPtr a, FieldPtr b) {
      return Value{std::vector<FieldPtr>{std::move(a), std::move(b)}};
    };
    const FieldPtr noise =
        makeField("multiply", {{"inputs", list(makeField("constant", {{"value", 0.8}}), fbm)}});
    const FieldPtr lifted =
        makeField("add", {{"inputs", list(noise, makeField("constant", {{"value", 0.5}}))}});
    inner = makeField("multiply", {{"inputs", list(makeField("sphere"), lifted)}});
    warped = makeField("warp", {{"input", inner}, {"octaves", int64_t{2}}});
    cloud = makeField("multiply", {{"inputs", list(makeField("height_profile"), warped)}});
  }
};

TEST(Warp, ReadsItsInputAtDisplacedPlaces) {
  const ReportSphere report;
  const uint32_t seed = shared::hashCell({0, 1, 0}, 0u);
  double farthest = 0.0;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 p(std::sin(n * 1.1) * 0.8, std::sin(n * 1.7) * 0.8, std::sin(n * 2.3) * 0.8);
    glm::dvec3 q = p;
    for (int axis = 0; axis < 3; ++axis) {
      const float zero = 0.0f;
      float shift = 0.0f;
      for (const NoiseOctave& octave : fbmOctaves(
               {1.0, 2, 2.0, 0.5, 0, shared::seedApart(seed, axis), {}, {}}, {0.01, 2, 0, nullptr}, "warp"))
        addNoiseAtPoints(&octave, 1, Points{p, 1, &zero, &zero, &zero}, &shift);
      q[axis] += 0.8 * double(shift);
    }
    ASSERT_NEAR(valueAt(*report.warped, p), valueAt(*report.inner, q), 1e-5);
    farthest = std::max(farthest, std::abs(q.x - p.x));
  }
  EXPECT_GT(farthest, 0.2) << "the displacement never came near warp_scale";
}

TEST(ReportSphere, IsItsFormula) {
  const ReportSphere report;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 p(std::sin(n * 1.1) * 0.8, std::sin(n * 1.7) * 0.8, std::sin(n * 2.3) * 0.8);
    const double base = std::max(0.0, 1.0 - std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
    ASSERT_NEAR(valueAt(*report.inner, p), base * (0.8 * double(valueAt(*report.fbm, p)) + 0.5), 1e-6);
    const double profile = std::clamp(((p.z + 1.0) / 2.0 - 0.5) / 0.5, 0.0, 1.0);
    ASSERT_NEAR(valueAt(*report.cloud, p), profile * double(valueAt(*report.warped, p)), 1e-6);
  }
}

}  // namespace
}  // namespace nephele::test
