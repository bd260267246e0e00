// The shared numbers: orders and places that cover evenly.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "preview/gpu/sub_pixels.h"
#include "shaders/shared/leaves.h"

namespace nephele::shared {
namespace {

constexpr uint kSeeds[] = {0u, 1u, 0xdeadbeefu};

TEST(SharedRandom, AnOrdersAlignedRunsAreSuchRunsShuffled) {
  for (const uint seed : kSeeds)
    for (int k = 1; k <= 10; ++k) {
      const uint run = 1u << k;
      for (const uint first : {0u, run, 37u * run}) {
        std::set<uint> places;
        for (uint i = 0; i < run; ++i) {
          const uint shuffled = shuffledNumber(first + i, seed);
          EXPECT_EQ(shuffled >> k, shuffledNumber(first, seed) >> k) << seed << ' ' << first + i;
          places.insert(shuffled);
        }
        EXPECT_EQ(places.size(), run) << seed << ' ' << first;
      }
    }
  EXPECT_NE(shuffledNumber(0u, 0u), shuffledNumber(0u, 1u));
}

// A (0, 2)-sequence: each aligned run of 2^k has one place in each box of 2^a by 2^(k-a).
TEST(SharedRandom, EvenPlacesHaveOneInEachBoxOfEveryGrid) {
  constexpr int kLog = 8;
  for (const uint seed : kSeeds)
    for (const uint first : {0u, 5u << kLog, 0xabcdefu << kLog})
      for (int a = 0; a <= kLog; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (uint i = 0; i < 1u << kLog; ++i) {
          const vec2 at = evenPlace(first + i, seed);
          ASSERT_TRUE(at.x >= 0.0f && at.x < 1.0f && at.y >= 0.0f && at.y < 1.0f) << at.x << ' ' << at.y;
          boxes.insert({static_cast<int>(std::ldexp(at.x, a)), static_cast<int>(std::ldexp(at.y, kLog - a))});
        }
        EXPECT_EQ(boxes.size(), size_t{1} << kLog) << seed << ' ' << first << ' ' << a;
      }
  EXPECT_NE(evenPlace(0u, 0u), evenPlace(0u, 1u));
}

TEST(SubPixels, CoverThePixelEvenlyFromItsMiddleOn) {
  constexpr int kEdge = 8;
  for (const unsigned seed : {0u, 1u, 11u}) {
    EXPECT_EQ(subPixelOffset(0, seed), vec2(0.5f)) << seed;
    std::set<std::pair<int, int>> boxes;
    for (unsigned n = 0; n < kEdge * kEdge; ++n) {
      const vec2 at = subPixelOffset(n, seed);
      ASSERT_TRUE(at.x >= 0.0f && at.x < 1.0f && at.y >= 0.0f && at.y < 1.0f) << at.x << ' ' << at.y;
      boxes.insert({static_cast<int>(kEdge * at.x), static_cast<int>(kEdge * at.y)});
    }
    EXPECT_EQ(boxes.size(), size_t{kEdge * kEdge}) << seed;
  }
  EXPECT_NE(subPixelOffset(1, 1), subPixelOffset(1, 2));
}

}  // namespace
}  // namespace nephele::shared
