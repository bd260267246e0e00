// The pass over a leaf: what is kept, rounded, summed and refused, and equal bits on every SIMD target.
#include <openvdb/Types.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "bake/voxelize_kernels.h"
#include "base/half.h"
#include "tests/bake/every_target.h"

namespace nephele::test {
namespace {

constexpr size_t kValues = 512;

/// Floats of all sizes between 2^-30 and 2^16, some exactly between two halves, some negative or 0.
std::vector<float> assorted(uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> values(kValues);
  for (float& value : values) {
    const uint32_t bits = random();
    value = std::ldexp(1.0f + float(bits & 0x7fffffu) / 8388608.0f, int(bits >> 23 & 31u) % 46 - 30);
    if (value > kLargestHalf) value = kLargestHalf;
    if (bits >> 30 == 0) value = std::bit_cast<float>((std::bit_cast<uint32_t>(value) & ~0x1fffu) | 0x1000u);
    if (bits >> 29 == 7) value = -value;
    if (bits >> 28 == 6) value = 0.0f;
  }
  return values;
}

TEST(LeafScan, RoundsToHalfAsOpenVdbStoresIt) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    const std::vector<float> given = assorted(seed);
    std::vector<float> values = given;
    const LeafScan scan = scanLeaf({0.0f, kLargestHalf, true}, values.data());
    ASSERT_TRUE(scan.storable);
    for (size_t n = 0; n < kValues; ++n) {
      const float expected = given[n] > 0.0f ? float(openvdb::math::half(given[n])) : 0.0f;
      ASSERT_EQ(std::bit_cast<uint32_t>(values[n]), std::bit_cast<uint32_t>(expected)) << given[n];
      ASSERT_EQ(scan.mask[n / 64] >> (n % 64) & 1u, uint64_t(expected > 0.0f));
    }
  }
}

TEST(LeafScan, RoundsToMultiplesOfAStepAndNothingToZero) {
  for (const bool half : {false, true})
    for (const float step : {0x1p-24f, 0x1p-6f, 0.25f, 0x1p15f})
      for (uint32_t seed = 0; seed < 50; ++seed) {
        const std::vector<float> given = assorted(seed);
        std::vector<float> values = given, unstepped = given;
        const LeafScan scan = scanLeaf({0.0f, kLargestHalf, half, step}, values.data());
        const LeafScan plain = scanLeaf({0.0f, kLargestHalf, half}, unstepped.data());
        for (size_t word = 0; word < 8; ++word) ASSERT_EQ(scan.mask[word], plain.mask[word]);
        for (size_t n = 0; n < kValues; ++n) {
          if (given[n] <= 0.0f) continue;
          // A power of two below the step; halves have no finer unit than 2^-24.
          double unit = std::min(double(step), std::exp2(std::floor(std::log2(double(given[n])))));
          if (half) unit = std::max(unit, 0x1p-24);
          double expected = std::nearbyint(double(given[n]) / unit) * unit;
          if (expected > double(kLargestHalf)) expected -= unit;
          if (half) expected = double(float(openvdb::math::half(float(expected))));
          ASSERT_EQ(double(values[n]), double(float(expected))) << given[n] << " by " << step;
        }
      }
}

TEST(LeafScan, AStepRoundsTiesToEvenAndKeepsToTheLimit) {
  const std::pair<float, float> cases[] = {{0.125f, 0.125f}, {0.375f, 0.5f},    {0.625f, 0.5f},
                                           {0.626f, 0.75f},  {0.875f, 1.0f},    {0.18f, 0.125f},
                                           {0.1875f, 0.25f}, {3000.1f, 3000.0f}};
  for (const auto& [given, expected] : cases) {
    std::vector<float> values(kValues, given);
    scanLeaf({0.0f, kLargestHalf, true, 0.25f}, values.data());
    EXPECT_EQ(values[0], expected) << given;
  }
  std::vector<float> values(kValues, kLargestHalf);
  EXPECT_EQ(scanLeaf({0.0f, kLargestHalf, true, 0x1p15f}, values.data()).maximum, 0x1p15f);
}

TEST(LeafScan, CutsAtTheCutoffAndSumsWhatIsLeft) {
  std::vector<float> values(kValues, 0.25f);
  for (size_t n = 0; n < kValues; n += 2) values[n] = 0.5f + float(n) / 1024.0f;
  const LeafScan scan = scanLeaf({0.25f, kLargestHalf, false}, values.data());
  double sum = 0.0;
  for (size_t n = 0; n < kValues; ++n) {
    EXPECT_EQ(values[n], n % 2 == 0 ? 0.5f + float(n) / 1024.0f : 0.0f);
    sum += double(values[n]);
  }
  EXPECT_NEAR(scan.mass, sum, 1e-6 * sum);
  EXPECT_EQ(scan.maximum, 0.5f + 510.0f / 1024.0f);
  EXPECT_TRUE(scan.active);
  EXPECT_EQ(scan.mask[3], 0x5555555555555555u);
  std::vector<float> nothing(kValues, 0.25f);
  EXPECT_FALSE(scanLeaf({0.25f, kLargestHalf, false}, nothing.data()).active);
}

TEST(LeafScan, SeesWhatCannotBeStored) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::nanf(""), kInfinity, -kInfinity, 65505.0f})
    for (const size_t place : {size_t(0), size_t(7), size_t(511)}) {
      std::vector<float> values(kValues, 0.5f);
      values[place] = bad;
      EXPECT_FALSE(scanLeaf({0.0f, kLargestHalf, true}, values.data()).storable) << bad << " at " << place;
    }
  std::vector<float> values(kValues, -1e30f);
  EXPECT_TRUE(scanLeaf({0.0f, kLargestHalf, true}, values.data()).storable);
}

TEST(LeafScan, EveryTargetGivesEqualBits) {
  expectEqualBitsOnEveryTarget([] {
    std::vector<float> all;
    for (const LeafRules& rules :
         {LeafRules{1e-4f, kLargestHalf, false}, LeafRules{1e-4f, kLargestHalf, true},
          LeafRules{1e-4f, kLargestHalf, false, 0.25f}, LeafRules{1e-4f, kLargestHalf, true, 0x1p-9f}})
      for (uint32_t seed = 0; seed < 20; ++seed) {
        std::vector<float> values = assorted(seed);
        const LeafScan scan = scanLeaf(rules, values.data());
        all.insert(all.end(), values.begin(), values.end());
        all.insert(all.end(), {float(scan.mass), scan.maximum, float(scan.active)});
        for (const uint64_t word : scan.mask) all.push_back(float(word % 16777213u));
      }
    return all;
  });
}

}  // namespace
}  // namespace nephele::test
