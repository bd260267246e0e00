// What the index says and the atlas holds, read back as a shader would, against the bricks; halves against
// their definition; the promise of texelError against rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "volume/brick_layout.h"
#include "volume/brick_packing.h"

namespace nephele {
namespace {

/// A few lumps in emptiness, with bricks that are filled by half along each axis, and a constant block.
BrickVolume lumps(float scale = 1.0f) {
  const glm::ivec3 size(70, 61, 53);
  std::vector<float> values;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double wave = std::sin(0.21 * x + 0.1 * y) * std::cos(0.17 * z - 0.13 * y) - 0.35;
        const bool block = x >= 8 && x < 34 && y >= 8 && y < 34 && z >= 8 && z < 34;
        values.push_back(block ? 0.5f * scale : scale * static_cast<float>(std::max(0.0, wave)));
      }
  glm::dmat4 worldFromIndex(1.0);
  worldFromIndex[1] = glm::dvec4(0.3, 1.7, 0.0, 0.0);
  return bricksFromDense(values, size, {-11, 3, 5}, worldFromIndex);
}

/// The atlas's texels as a texture gives them, without scales.
std::vector<float> atlasOf(const BrickLayout& layout) {
  std::vector<float> all;
  std::vector<std::byte> texels;
  for (const AtlasSlab& slab : layout.slabs) {
    EXPECT_EQ(all.size(), static_cast<size_t>(layout.size.x) * static_cast<size_t>(layout.size.y) *
                              static_cast<size_t>(slab.z));
    writeSlab(layout, slab, texels);
    const size_t before = all.size();
    all.resize(before + texels.size() / bytesOf(layout.texel));
    readTexels(layout.texel, texels, all.data() + before);
  }
  return all;
}

/// A sample of a brick from its word alone; 0 beyond what is kept.
float sampleOf(const BrickLayout& layout, const std::vector<float>& atlas, const glm::uvec2& word,
               const glm::ivec3& sample) {
  if (brick_word::isEmpty(word)) return 0.0f;
  glm::ivec3 at = brick_word::corner(word);
  for (int axis = 0; axis < 3; ++axis) {
    const bool halved = (word.y >> brick_word::kHalvedShift >> axis & 1) != 0;
    const bool upper = (word.y >> brick_word::kUpperShift >> axis & 1) != 0;
    const int local = sample[axis] - (upper ? kBrickCells / 2 : 0);
    if (local < 0 || local >= (halved ? kHalfSamples : kBrickSamples)) return 0.0f;
    at[axis] += local;
  }
  const float kept =
      atlas[(static_cast<size_t>(at.z) * static_cast<size_t>(layout.size.y) + static_cast<size_t>(at.y)) *
                static_cast<size_t>(layout.size.x) +
            static_cast<size_t>(at.x)];
  return layout.scaled() ? kept * brick_bounds::bound(brick_word::maximumCode(word), layout.maximum) : kept;
}

TEST(BrickLayout, TheAtlasHoldsEverySampleWithinItsBounds) {
  const BrickVolume volume = lumps();
  for (const Texel texel : {Texel::r8, Texel::r16f, Texel::r32f}) {
    const BrickLayout layout = layOut(volume, {texel, kLeastTextureLimit, {}, 0, 0});
    const std::vector<float> atlas = atlasOf(layout);
    for (size_t i = 0; i < volume.index.size(); ++i) {
      const glm::uvec2 word = layout.words[i];
      ASSERT_EQ(brick_word::isEmpty(word), volume.index[i] == 0);
      if (volume.index[i] == 0) continue;
      const float* samples = volume.samples.data() + (volume.index[i] - 1) * size_t{kBrickVolume};
      const float bound = brick_bounds::bound(brick_word::maximumCode(word), layout.maximum);
      const float share = static_cast<float>(word.y >> brick_word::kMinimumShift) / 255.0f;
      float most = 0.0f, least = std::numeric_limits<float>::max();
      for (int k = 0; k < kBrickVolume; ++k) {
        const glm::ivec3 at(k % kBrickSamples, k / kBrickSamples % kBrickSamples,
                            k / (kBrickSamples * kBrickSamples));
        const float read = sampleOf(layout, atlas, word, at);
        ASSERT_NEAR(read, keptAs(texel, samples[k], bound), 1e-7f * bound);
        most = std::max(most, read);
        least = std::min(least, read);
      }
      EXPECT_LE(most, bound);
      EXPECT_LT(bound, 1.126f * most) << "an eighth above the maximum at most";
      EXPECT_LE(share * most, least * 1.000001f);
    }
  }
}

TEST(BrickLayout, BricksThatAreHalfEmptyKeepHalf) {
  const BrickLayout layout = layOut(lumps());
  size_t whole = 0, halved = 0;
  for (const BrickSlot& slot : layout.slots) (slot.size == glm::ivec3(kBrickSamples) ? whole : halved) += 1;
  EXPECT_GT(halved, 20u);
  EXPECT_GT(whole, 20u);
  size_t used = 0;
  for (const BrickSlot& slot : layout.slots)
    used += static_cast<size_t>(slot.size.x) * static_cast<size_t>(slot.size.y) *
            static_cast<size_t>(slot.size.z);
  EXPECT_LT(used, layout.slots.size() * kBrickVolume * 9 / 10);
}

TEST(BrickLayout, RefusesWhatTexturesCannotHold) {
  const BrickVolume volume = lumps();
  EXPECT_NO_THROW(layOut(volume, {Texel::r32f, 192, {}, 0, 0}));
  EXPECT_THROW(layOut(volume, {Texel::r32f, 32, {}, 0, 0}), InputError);
}

TEST(BrickPacking, BoxesLieApartAndLeaveLittleUnused) {
  std::mt19937 random(1);
  std::vector<glm::ivec3> sizes;
  const auto side = [&] { return random() % 4 == 0 ? kHalfSamples : kBrickSamples; };
  for (int i = 0; i < 3000; ++i) sizes.emplace_back(side(), side(), side());
  const Packing packing = packBoxes(sizes, kLeastTextureLimit).value();
  std::vector<uint8_t> taken(static_cast<size_t>(packing.size.x) * static_cast<size_t>(packing.size.y) *
                             static_cast<size_t>(packing.size.z));
  size_t used = 0;
  for (size_t i = 0; i < sizes.size(); ++i)
    for (int z = 0; z < sizes[i].z; ++z)
      for (int y = 0; y < sizes[i].y; ++y)
        for (int x = 0; x < sizes[i].x; ++x, ++used) {
          const glm::ivec3 at = packing.corners[i] + glm::ivec3(x, y, z);
          ASSERT_TRUE(at.x < packing.size.x && at.y < packing.size.y && at.z < packing.size.z);
          uint8_t& texel = taken[(static_cast<size_t>(at.z) * static_cast<size_t>(packing.size.y) +
                                  static_cast<size_t>(at.y)) *
                                     static_cast<size_t>(packing.size.x) +
                                 static_cast<size_t>(at.x)];
          ASSERT_EQ(texel, 0);
          texel = 1;
        }
  EXPECT_LT(static_cast<double>(taken.size()), 1.03 * static_cast<double>(used));
  EXPECT_EQ(packBoxes(sizes, kLeastTextureLimit)->corners, packing.corners);
  EXPECT_FALSE(packBoxes(sizes, 64).has_value());
}

TEST(BrickTexel, HalvesAreTheNearest) {
  for (uint32_t half = 0; half < 0x7c00; ++half)
    ASSERT_EQ(halfOf(fromHalf(static_cast<uint16_t>(half))), half);
  EXPECT_EQ(fromHalf(0x3c00), 1.0f);
  EXPECT_EQ(fromHalf(1), 0x1p-24f);
  EXPECT_EQ(fromHalf(0x7bff), 65504.0f);
  EXPECT_EQ(halfOf(65519.0f), 0x7bff);
  EXPECT_EQ(halfOf(65520.0f), 0x7c00);
  EXPECT_EQ(halfOf(1.0f + 0x1p-11f), 0x3c00) << "a tie goes to the even one";
  EXPECT_EQ(halfOf(1.0f + 0x3p-11f), 0x3c02);
  std::mt19937 random(2);
  for (int i = 0; i < 100000; ++i) {
    const float value =
        std::ldexp(static_cast<float>(random() % (1u << 24)), -24 - static_cast<int>(random() % 24));
    const uint16_t half = halfOf(value);
    const float error = std::abs(fromHalf(half) - value);
    ASSERT_LE(error, std::abs(fromHalf(static_cast<uint16_t>(half + 1)) - value));
    if (half > 0) {
      ASSERT_LE(error, std::abs(fromHalf(static_cast<uint16_t>(half - 1)) - value));
    }
  }
}

TEST(BrickTexel, NoRayErrsByMoreThanPromised) {
  const BrickVolume volume = lumps();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto place = [&] {
    return glm::dvec3(-12.0 + 71.0 * uniform(random), 2.0 + 62.0 * uniform(random),
                      4.0 + 54.0 * uniform(random));
  };
  for (const Texel texel : {Texel::r8, Texel::r16f}) {
    BrickVolume kept = volume;
    const BrickLayout layout = layOut(volume, {texel, kLeastTextureLimit, {}, 0, 0});
    for (const BrickSlot& slot : layout.slots) {
      float* samples = kept.samples.data() + (slot.samples - volume.samples.data());
      for (int i = 0; i < kBrickVolume; ++i) samples[i] = keptAs(texel, samples[i], slot.scale);
    }
    double worst = 0.0, deepest = 0.0;
    for (int ray = 0; ray < 1500; ++ray) {
      const glm::dvec3 middle = place();
      glm::dvec3 way = place() - middle;
      if (ray % 3 == 0) way = glm::dvec3(ray % 9 == 0, ray % 9 == 3, ray % 9 == 6);
      const glm::dvec4 world = volume.worldFromIndex * glm::dvec4(way, 0.0);
      const double step = 0.5 / std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
      const double length = step * std::sqrt(world.x * world.x + world.y * world.y + world.z * world.z);
      double depth = 0.0, error = 0.0;
      for (double t = -200.0 * step; t < 200.0 * step; t += step) {
        const double there = densityAt(volume, middle + t * way);
        depth += there * length;
        error += (densityAt(kept, middle + t * way) - there) * length;
      }
      worst = std::max(worst, std::abs(error));
      deepest = std::max(deepest, depth);
    }
    const double bound = texelError(volume, texel);
    std::printf("%s: worst ray %.3g of the deepest, bound %.3g\n", std::string(nameOf(texel)).c_str(),
                worst / deepest, bound);
    EXPECT_LT(worst, bound * deepest);
    EXPECT_GT(worst, 0.01 * bound * deepest) << "a bound this loose says nothing";
  }
}

TEST(BrickTexel, TheSmallestThatIsAsGoodIsTaken) {
  const auto chosen = [](float a, float b) {
    std::vector<float> values(20 * 20 * 20, a);
    for (size_t i = 0; i < values.size(); i += 7) values[i] = b;
    return chooseTexel(bricksFromDense(values, glm::ivec3(20), glm::ivec3(0), glm::dmat4(1.0)));
  };
  EXPECT_EQ(chosen(0.7f, 0.7f), Texel::r8) << "constant: exact";
  EXPECT_EQ(chosen(0.7f, 0.0f), Texel::r8);
  EXPECT_EQ(chosen(0.7f, 0.3337f), Texel::r16f);
  EXPECT_EQ(chosen(7e4f, 3e4f), Texel::r32f) << "beyond halves";
  EXPECT_EQ(chosen(1e-9f, 3e-9f), Texel::r32f) << "below halves";
  EXPECT_EQ(chooseTexel(BrickVolume{}), Texel::r8);
  // One brick alone is not constant, whichever it is.
  constexpr int kEdge = 40, kBricks = 5;
  for (int at = 0; at < kBricks; ++at) {
    std::vector<float> values(kEdge * kEdge * kEdge, 0.7f);
    for (int i = 0; i < kEdge; ++i)
      values[static_cast<size_t>(i * kEdge * kEdge + (8 * at + 4) * (kEdge + 1))] = 0.3337f;
    const BrickVolume volume = bricksFromDense(values, glm::ivec3(kEdge), glm::ivec3(0), glm::dmat4(1.0));
    EXPECT_GT(texelError(volume, Texel::r8), kTexelError);
    EXPECT_EQ(chooseTexel(volume), Texel::r16f) << at;
  }
  EXPECT_EQ(texelError(lumps(), Texel::r32f), 0.0);
  EXPECT_LT(texelError(lumps(), Texel::r16f), 4.9e-4);
}

}  // namespace
}  // namespace nephele
