// Places, bounds and empty cubes of bricks. Depends on volume/bricks.h, base and TBB.
#include "volume/brick_layout.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace nephele {
namespace brick_word {

uint32_t maximumCode(float value, float maximum) {
  for (int code = 1; code < kMostCode; ++code)  // as the shaders compute the bound, and compared with it
    if (value <= maximum * std::exp2(0.5f * static_cast<float>(code - kMostCode)))
      return static_cast<uint32_t>(code);
  return kMostCode;
}

uint32_t minimumCode(float minimum, float maximum) {
  uint32_t code = kMinimumMask;
  while (code > 0 && minimum < maximum * kMinimumShares[code]) --code;
  return code;
}

}  // namespace brick_word

namespace {

using namespace brick_word;

constexpr int kBlockPlaceBits = 10;
constexpr int kMostEmptyLevel = 15;  // far below kFirstFull, and more bricks than any index is long

int64_t divideUp(int64_t a, int64_t b) { return (a + b - 1) / b; }

/// Places along each axis, at most `most`: nearly a cube, of those the one that leaves the least unused.
glm::ivec3 placesFor(size_t needed, const glm::ivec3& most) {
  const int64_t count = std::max<int64_t>(static_cast<int64_t>(needed), 1);
  const int edge = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count))));
  constexpr int kReach = 6;  // the longer the reach, the flatter boxes are looked at
  glm::ivec3 best(0);
  int64_t least = 0;
  for (int z = std::clamp(edge - kReach, 1, most.z); z <= std::min(edge + kReach, most.z); ++z)
    for (int y = std::clamp(edge - kReach, 1, most.y); y <= most.y; ++y) {
      const int64_t x = divideUp(count, int64_t{y} * z);
      if (x > most.x) continue;
      if (least == 0 || x * y * z < least) {
        best = {static_cast<int>(x), y, z};
        least = x * y * z;
      }
      if (x <= edge - kReach) break;
    }
  if (least == 0)
    throw InputError({}, "the grid needs " + std::to_string(count) +
                             " bricks, more than the driver's 3-D textures hold (" +
                             std::to_string(int64_t{most.x} * most.y * most.z) + ")");
  return best;
}

struct Levels {
  std::vector<glm::ivec3> counts;
  std::vector<std::vector<uint8_t>> full;  // per level, x fastest: whether the cube holds density
};

size_t at(const glm::ivec3& count, const glm::ivec3& p) {
  return (static_cast<size_t>(p.z) * static_cast<size_t>(count.y) + static_cast<size_t>(p.y)) *
             static_cast<size_t>(count.x) +
         static_cast<size_t>(p.x);
}

/// Which aligned cubes of 2^L bricks hold density, from level 0 to the one that is a single cube.
Levels occupancy(const BrickVolume& volume) {
  Levels levels;
  levels.counts.push_back(volume.brickCount);
  levels.full.emplace_back(volume.index.size());
  std::transform(volume.index.begin(), volume.index.end(), levels.full[0].begin(),
                 [](uint32_t slot) { return static_cast<uint8_t>(slot != 0); });
  while (std::max({levels.counts.back().x, levels.counts.back().y, levels.counts.back().z}) > 1) {
    const glm::ivec3 below = levels.counts.back(), count = (below + 1) / 2;
    std::vector<uint8_t> full(at(count, {0, 0, count.z}), 0);
    const std::vector<uint8_t>& from = levels.full.back();
    for (int z = 0; z < below.z; ++z)
      for (int y = 0; y < below.y; ++y)
        for (int x = 0; x < below.x; ++x)
          full[at(count, {x / 2, y / 2, z / 2})] |= from[at(below, {x, y, z})];
    levels.counts.push_back(count);
    levels.full.push_back(std::move(full));
  }
  return levels;
}

uint32_t emptyLevel(const Levels& levels, const glm::ivec3& brick) {
  uint32_t level = 0;
  while (level + 1 < levels.counts.size() && level < kMostEmptyLevel &&
         levels.full[level + 1][at(levels.counts[level + 1], {brick.x >> (level + 1), brick.y >> (level + 1),
                                                              brick.z >> (level + 1)})] == 0)
    ++level;
  return level;
}

uint32_t fullWord(const BrickVolume& volume, uint32_t slot, const glm::ivec3& places) {
  const uint32_t nx = static_cast<uint32_t>(places.x), ny = static_cast<uint32_t>(places.y);
  const float* samples = volume.samples.data() + size_t{slot} * kBrickVolume;
  const auto [least, most] = std::minmax_element(samples, samples + kBrickVolume);
  return slot % nx | (slot / nx % ny) << kPlaceShiftY | (slot / (nx * ny)) << kPlaceShiftZ |
         minimumCode(*least, *most) << kMinimumShift |
         maximumCode(*most, static_cast<float>(volume.maximum)) << kMaximumShift;
}

void findBlocks(const BrickVolume& volume, int limitTexels, BrickLayout& layout) {
  layout.blockCount = (layout.brickCount + kBlockBricks - 1) / kBlockBricks;
  const glm::ivec3 count = layout.blockCount;
  std::vector<uint8_t> full(at(count, {0, 0, count.z}), 0);
  for (int z = 0; z < volume.brickCount.z; ++z)
    for (int y = 0; y < volume.brickCount.y; ++y)
      for (int x = 0; x < volume.brickCount.x; ++x)
        if (volume.index[at(volume.brickCount, {x, y, z})] != 0)
          full[at(count, {x / kBlockBricks, y / kBlockBricks, z / kBlockBricks})] = 1;
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x)
        if (full[at(count, {x, y, z})] != 0) layout.blocks.emplace_back(x, y, z);
  const int mostXy = std::min(limitTexels / kMostBlockSamples, 1 << kBlockPlaceBits);
  const int mostZ = std::max(1, limitTexels / (kMostBlockSamples * kMostCachedLights));
  layout.blockPlaces = placesFor(layout.blocks.size(), {mostXy, mostXy, mostZ});
  layout.blockWords.assign(full.size(), 0);
  const uint32_t nx = static_cast<uint32_t>(layout.blockPlaces.x),
                 ny = static_cast<uint32_t>(layout.blockPlaces.y);
  for (uint32_t i = 0; i < layout.blocks.size(); ++i)
    layout.blockWords[at(count, layout.blocks[i])] =
        1 + (i % nx | (i / nx % ny) << kBlockPlaceBits | (i / (nx * ny)) << (2 * kBlockPlaceBits));
}

}  // namespace

BrickLayout layOut(const BrickVolume& volume, int limitTexels) {
  BrickLayout layout;
  layout.brickCount = volume.brickCount;
  if (volume.empty()) return layout;
  const int most = limitTexels / kBrickSamples;
  layout.places =
      placesFor(volume.slotCount(), {std::min<int>(most, kPlaceMask + 1), std::min<int>(most, kPlaceMask + 1),
                                     std::min<int>(most, kPlaceMaskZ + 1)});
  layout.words.resize(volume.index.size());
  for (size_t slot = 0; slot < volume.slotCount(); ++slot)
    layout.bricks.push_back(volume.samples.data() + slot * kBrickVolume);
  const Levels levels = occupancy(volume);
  std::vector<uint32_t> words(volume.slotCount());
  tbb::parallel_for(size_t{0}, words.size(), [&](size_t slot) {
    words[slot] = fullWord(volume, static_cast<uint32_t>(slot), layout.places);
  });
  const glm::ivec3 count = volume.brickCount;
  tbb::parallel_for(0, count.z, [&](int z) {
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) {
        const size_t i = at(count, {x, y, z});
        layout.words[i] = volume.index[i] == 0 ? emptyLevel(levels, {x, y, z}) : words[volume.index[i] - 1];
      }
  });
  findBlocks(volume, limitTexels, layout);
  return layout;
}

}  // namespace nephele
