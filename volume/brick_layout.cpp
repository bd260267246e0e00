// Places, bounds and empty cubes of bricks. Depends on volume/bricks.h, base and TBB.
#include "volume/brick_layout.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/error.h"
#include "volume/brick_packing.h"

namespace nephele {
namespace {

using namespace brick_word;

constexpr int kBlockPlaceBits = 10;
constexpr int kMostEmptyLevel = 15;  // more bricks than any index is long

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
                             " blocks of cached light, more than the driver's 3-D textures hold (" +
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

/// What a brick's samples say: which of them must be kept, and their bounds as they will be read.
struct SlotShape {
  glm::ivec3 first{0}, size{kBrickSamples};
  uint32_t maximumCode = 0, minimumShare = 0;
};

/// Along an axis where no sample from `4` on, or none up to it, is above 0, half of the samples tell all.
SlotShape shapeOf(const float* samples, Texel texel, float maximum) {
  constexpr int kMiddle = kBrickCells / 2;
  bool lower[3] = {true, true, true}, upper[3] = {true, true, true};
  const float* sample = samples;
  float most = 0.0f;
  for (int z = 0; z < kBrickSamples; ++z)
    for (int y = 0; y < kBrickSamples; ++y)
      for (int x = 0; x < kBrickSamples; ++x, ++sample) {
        if (!(*sample > 0.0f)) continue;
        most = std::max(most, *sample);
        const int at[3] = {x, y, z};
        for (size_t axis = 0; axis < 3; ++axis) {
          lower[axis] = lower[axis] && at[axis] < kMiddle;
          upper[axis] = upper[axis] && at[axis] > kMiddle;
        }
      }
  SlotShape shape;
  for (int axis = 0; axis < 3; ++axis) {
    if (!lower[axis] && !upper[axis]) continue;
    shape.size[axis] = kHalfSamples;
    shape.first[axis] = lower[axis] ? 0 : kMiddle;
  }
  if (texel == Texel::r16f) most = keptAs(texel, most, 0.0f);
  shape.maximumCode = brick_bounds::codeFor(most, maximum);
  const float scale = brick_bounds::bound(shape.maximumCode, maximum);
  // What is kept grows with what is given, so the least stays the least.
  const float least = keptAs(texel, *std::min_element(samples, samples + kBrickVolume), scale);
  shape.minimumShare = brick_bounds::shareFor(least, most);
  return shape;
}

glm::uvec2 wordOf(const BrickSlot& slot, const SlotShape& shape) {
  const glm::uvec3 corner(slot.corner);
  uint32_t halves = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (slot.size[axis] != kBrickSamples) halves |= 1u << kHalvedShift << axis;
    if (slot.first[axis] != 0) halves |= 1u << kUpperShift << axis;
  }
  return {corner.x | corner.y << kCornerBits | shape.maximumCode << kMaximumShift,
          corner.z | halves | shape.minimumShare << kMinimumShift};
}

/// Shapes, packs and names all bricks; returns the word of each of the volume's slots.
std::vector<glm::uvec2> placeBricks(const BrickVolume& volume, int limitTexels, BrickLayout& layout) {
  std::vector<SlotShape> shapes(volume.slotCount());
  layout.maximum = keptAs(layout.texel == Texel::r8 ? Texel::r32f : layout.texel,
                          static_cast<float>(volume.maximum), 0.0f);
  tbb::parallel_for(size_t{0}, shapes.size(), [&](size_t slot) {
    shapes[slot] = shapeOf(volume.samples.data() + slot * kBrickVolume, layout.texel, layout.maximum);
  });
  std::vector<glm::ivec3> sizes;
  for (const SlotShape& shape : shapes) sizes.push_back(shape.size);
  const Packing packing = packBoxes(sizes, std::min<int>(limitTexels, kCornerMask + 1));
  layout.size = packing.size;
  std::vector<glm::uvec2> words(shapes.size());
  for (const size_t slot : packing.order) {
    const SlotShape& shape = shapes[slot];
    layout.slots.push_back({volume.samples.data() + slot * kBrickVolume, packing.corners[slot], shape.first,
                            shape.size, brick_bounds::bound(shape.maximumCode, layout.maximum)});
    words[slot] = wordOf(layout.slots.back(), shape);
    if (layout.slabs.empty() || layout.slabs.back().z != packing.corners[slot].z)
      layout.slabs.push_back({packing.corners[slot].z, shape.size.z, layout.slots.size() - 1, 0});
    ++layout.slabs.back().slotCount;
  }
  return words;
}

void writeRow(Texel texel, const float* samples, size_t count, float scale, std::byte* to) {
  for (size_t i = 0; i < count; ++i) {
    switch (texel) {
      case Texel::r8:
        to[i] = std::byte{byteOf(samples[i], scale)};
        break;
      case Texel::r16f: {
        const uint16_t half = halfOf(samples[i]);
        std::memcpy(to + i * sizeof half, &half, sizeof half);
        break;
      }
      case Texel::r32f:
        std::memcpy(to + i * sizeof(float), samples + i, sizeof(float));
        break;
    }
  }
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

BrickLayout layOut(const BrickVolume& volume, const LayoutOptions& options) {
  BrickLayout layout;
  layout.texel = options.texel;
  layout.brickCount = volume.brickCount;
  if (volume.empty()) return layout;
  const std::vector<glm::uvec2> words = placeBricks(volume, options.limitTexels, layout);
  layout.words.resize(volume.index.size());
  const Levels levels = occupancy(volume);
  const glm::ivec3 count = volume.brickCount;
  tbb::parallel_for(0, count.z, [&](int z) {
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) {
        const size_t i = at(count, {x, y, z});
        layout.words[i] =
            volume.index[i] == 0 ? glm::uvec2(0u, emptyLevel(levels, {x, y, z})) : words[volume.index[i] - 1];
      }
  });
  findBlocks(volume, options.limitTexels, layout);
  return layout;
}

void writeSlab(const BrickLayout& layout, const AtlasSlab& slab, std::vector<std::byte>& texels) {
  const size_t sampleBytes = bytesOf(layout.texel);
  const size_t row = static_cast<size_t>(layout.size.x), rows = static_cast<size_t>(layout.size.y);
  texels.assign(row * rows * static_cast<size_t>(slab.thickness) * sampleBytes, std::byte{0});
  tbb::parallel_for(slab.firstSlot, slab.firstSlot + slab.slotCount, [&](size_t i) {
    const BrickSlot& slot = layout.slots[i];
    for (int z = 0; z < slot.size.z; ++z)
      for (int y = 0; y < slot.size.y; ++y) {
        const glm::ivec3 from = slot.first + glm::ivec3(0, y, z);
        const float* samples = slot.samples + (from.z * kBrickSamples + from.y) * kBrickSamples + from.x;
        const size_t to = (static_cast<size_t>(z) * rows + static_cast<size_t>(slot.corner.y + y)) * row +
                          static_cast<size_t>(slot.corner.x);
        writeRow(layout.texel, samples, static_cast<size_t>(slot.size.x), slot.scale,
                 texels.data() + to * sampleBytes);
      }
  });
}

void readTexels(Texel texel, const std::vector<std::byte>& texels, float* values) {
  const size_t sampleBytes = bytesOf(texel), count = texels.size() / sampleBytes;
  constexpr float kByte = 255.0f;
  for (size_t i = 0; i < count; ++i) {
    const std::byte* from = texels.data() + i * sampleBytes;
    uint16_t half = 0;
    switch (texel) {
      case Texel::r8:
        values[i] = static_cast<float>(std::to_integer<uint8_t>(*from)) * (1.0f / kByte);
        break;
      case Texel::r16f:
        std::memcpy(&half, from, sizeof half);
        values[i] = fromHalf(half);
        break;
      case Texel::r32f:
        std::memcpy(values + i, from, sizeof(float));
        break;
    }
  }
}

}  // namespace nephele
