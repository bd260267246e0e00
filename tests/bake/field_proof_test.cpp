// The bounds of every row of the field table at full strength: a million random boxes each, with random
// parameters, sizes from 1e-6 to 1e6, up to 1e7 from the origin. field_bounds_test.cpp is the quick form.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <mutex>

#include "tests/bake/random_fields.h"

namespace nephele::test {
namespace {

constexpr int kFields = 250, kBoxes = 4000;  // a million boxes a row
constexpr int kMostPoints = 16;
constexpr int kBlockEvery = 32;  // one box in so many is a lattice block, of 512 points

/// Values, where they come from, and the interval that must hold them.
struct Sample {
  Box box;
  size_t count = 0;
  float values[kBlockPoints];
};

void evaluateInBox(const Field& field, FieldDrawer& drawer, Sample& sample) {
  sample.box = drawer.drawBox();
  sample.count = size_t(drawer.whole(1, kMostPoints));
  const glm::dvec3 size = sample.box.high - sample.box.low;
  float at[3][kMostPoints];
  for (int axis = 0; axis < 3; ++axis)
    for (size_t n = 0; n < sample.count; ++n)
      at[axis][n] = float(size[axis]) * (n < 2 ? float(n) : float(drawer.between(0.0, 1.0)));
  field.evaluate(Points{sample.box.low, sample.count, at[0], at[1], at[2]}, sample.values);
}

void evaluateOnBlock(const Field& field, FieldDrawer& drawer, Sample& sample) {
  sample.box = drawer.drawBox();
  const double spacing = std::max(sample.box.high.x - sample.box.low.x, 1e-30) / (kBlockEdge - 1);
  sample.box.high = sample.box.low + (kBlockEdge - 1) * spacing;
  sample.count = kBlockPoints;
  field.evaluate(Lattice{sample.box.low, spacing}, sample.values);
}

/// The first value outside, as a sentence; empty where there is none.
std::string strayIn(const Field& field, const World& world, const Sample& sample) {
  const Interval bounds = field.bounds(roundedOutwards(sample.box));
  for (size_t n = 0; n < sample.count; ++n) {
    if (bounds.low <= bounds.high && containsValue(bounds, double(sample.values[n]))) continue;
    std::ostringstream text;
    text.precision(17);
    text << sample.values[n] << " outside [" << bounds.low << ", " << bounds.high << "], point " << n
         << " of " << sample.count << ", size " << world.size << ", box";
    for (int axis = 0; axis < 3; ++axis) text << ' ' << sample.box.low[axis] << ".." << sample.box.high[axis];
    return text.str();
  }
  return {};
}

class EveryField : public testing::TestWithParam<std::string> {};

TEST_P(EveryField, AMillionBoxesHoldTheirValues) {
  std::mutex guard;
  std::vector<std::string> strays;
  tbb::parallel_for(0, kFields, [&](int number) {
    FieldDrawer drawer{uint64_t(number)};
    const World world = drawer.drawWorld();
    const FieldPtr field = drawer.draw(GetParam(), world);
    Sample sample;
    for (int b = 0; b < kBoxes; ++b) {
      if (b % kBlockEvery == 0)
        evaluateOnBlock(*field, drawer, sample);
      else
        evaluateInBox(*field, drawer, sample);
      const std::string stray = strayIn(*field, world, sample);
      if (stray.empty()) continue;
      const std::lock_guard lock(guard);
      strays.push_back("field " + std::to_string(number) + ", box " + std::to_string(b) + ": " + stray);
      return;
    }
  });
  std::sort(strays.begin(), strays.end());
  EXPECT_TRUE(strays.empty()) << strays.size() << " of " << kFields << " fields stray; one of them:\n"
                              << strays.front();
}

INSTANTIATE_TEST_SUITE_P(Table, EveryField, testing::ValuesIn(fieldNames()),
                         [](const auto& row) { return row.param; });

}  // namespace
}  // namespace nephele::test
