// Bubbles on bubbles: against closed forms and themselves.
#include <gtest/gtest.h>

#include <random>

#include "tests/bake/field_samples.h"

namespace nephele::test {
namespace {

using Vector = std::array<double, 3>;

TEST(Cauliflower, WithoutScalesIsItsEllipsoid) {
  const FieldPtr bare = makeField("cauliflower", {{"scales", int64_t{0}}, {"falloff", 0.2}});
  const FieldPtr ellipsoid = makeField("ellipsoid", {{"radii", Vector{0.55, 0.55, 0.42}}, {"falloff", 0.2}});
  std::mt19937_64 random(3);
  for (int n = 0; n < 2000; ++n) {
    const glm::dvec3 p = randomPoint(random, 0.8);
    ASSERT_EQ(valueAt(*bare, p), valueAt(*ellipsoid, p));
  }
}

TEST(Cauliflower, GrowsOutwardsWithEveryScaleAndNoFartherThanTheirSum) {
  std::mt19937_64 random(4);
  double volume[4] = {};
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 p = randomPoint(random, 1.0);
    float last = 0.0f;
    for (int scale = 0; scale < 4; ++scale) {
      static const FieldPtr fields[4] = {makeField("cauliflower", {{"scales", int64_t{0}}}),
                                         makeField("cauliflower", {{"scales", int64_t{1}}}),
                                         makeField("cauliflower", {{"scales", int64_t{2}}}),
                                         makeField("cauliflower", {{"scales", int64_t{3}}})};
      const float v = valueAt(*fields[scale], p);
      volume[scale] += double(v);
      ASSERT_GE(v, last) << "a bubble laid on takes nothing away";
      last = v;
    }
  }
  EXPECT_GT(volume[1], 1.1 * volume[0]);
  // Turned inwards, the second scale would add 1.24 alone.
  EXPECT_GT(volume[2], 1.27 * volume[1]);
  const Box box = makeField("cauliflower")->support();
  // 0.55 (1 + s + s² + s³) with s the largest ratio, 0.42 · 1.3.
  const double s = 0.42 * 1.3, most = 0.55 * (1.0 + s * (1.0 + s * (1.0 + s)));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.high[axis], most);
    EXPECT_GT(box.high[axis], 0.42);
  }
}

TEST(Cauliflower, LeavesOutWhatTheGridCannotHoldAndSaysSo) {
  // Bubbles 2 · 0.42^scale thick without jitter: 2, 0.84, 0.3528, 0.148.
  const auto at = [](double voxelSize, int64_t scales, std::vector<BandLimitNote>* notes) {
    return makeField("cauliflower", {{"radii", Vector{1, 1, 1}}, {"jitter", 0.0}, {"scales", scales}},
                     {voxelSize, 2, 0, notes});
  };
  std::vector<BandLimitNote> notes;
  // In voxels of 0.1176: 17, 7.1, 3 and 1.3.
  const FieldPtr all = at(0.1176, 3, &notes), two = at(0.1176, 2, nullptr), one = at(0.1176, 1, nullptr),
                 fine = at(0.01, 2, nullptr);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0].field, "cauliflower");
  EXPECT_EQ(notes[0].octave, 2);
  EXPECT_NEAR(notes[0].cellVoxels, 3.0, 1e-5);
  EXPECT_NEAR(notes[0].weight, 0.5, 1e-5);
  EXPECT_EQ(notes[1].octave, 3);
  EXPECT_EQ(notes[1].weight, 0.0);
  std::mt19937_64 random(6);
  for (int n = 0; n < 5000; ++n) {
    const glm::dvec3 p = randomPoint(random, 2.0);
    ASSERT_EQ(valueAt(*all, p), valueAt(*two, p)) << "the finest scale is not there";
    // Of what the second scale adds, half is left.
    ASSERT_NEAR(valueAt(*two, p), std::max(valueAt(*one, p), 0.5f * valueAt(*fine, p)), 1e-5f);
  }
  notes.clear();
  at(0.03, 3, &notes);
  EXPECT_TRUE(notes.empty()) << "all bubbles have four voxels";
}

TEST(Cauliflower, PrefersTheUpperSideAndFollowsItsSeed) {
  const FieldPtr a = makeField("cauliflower", {{"upward", 1.0}}),
                 b = makeField("cauliflower", {{"upward", 1.0}}),
                 other = makeField("cauliflower", {{"upward", 1.0}, {"seed", int64_t{1}}});
  EXPECT_GT(a->support().high.z, 1.1 * -a->support().low.z);
  std::mt19937_64 random(5);
  int differ = 0;
  for (int n = 0; n < 2000; ++n) {
    const glm::dvec3 p = randomPoint(random, 0.9);
    ASSERT_EQ(valueAt(*a, p), valueAt(*b, p));
    differ += valueAt(*a, p) != valueAt(*other, p);
  }
  EXPECT_GT(differ, 50);
}

TEST(Cauliflower, BlocksSeeEveryBubbleThatReachesThem) {
  const FieldPtr field = makeField("cauliflower");
  std::mt19937_64 random(6);
  for (int n = 0; n < 200; ++n) {
    const Lattice lattice{randomPoint(random, 0.9), 0.0078125};  // exact in floats
    float values[kBlockPoints];
    field->evaluate(lattice, values);
    for (int k = 0; k < kBlockPoints; k += 31)
      ASSERT_NEAR(values[k],
                  valueAt(*field, lattice.origin + lattice.spacing * glm::dvec3(k / 64, k / 8 % 8, k % 8)),
                  2e-5);
  }
}

}  // namespace
}  // namespace nephele::test
