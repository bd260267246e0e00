// Places, bounds and empty cubes of bricks. Depends on volume/bricks.h, base and TBB.
#include "volume/brick_layout.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

#include "base/error.h"
#include "volume/brick_packing.h"

namespace nephele {
namespace {

using namespace brick_word;

constexpr int kBlockPlaceBits = 10;
constexpr int kMostEmptyLevel = 15;  // more bricks than any index is long

int64_t divideUp(int64_t a, int64_t b) { return (a + b - 1) / b; }

/// Places along each axis, at most `most`: nearly a cube, of those the one that leaves the least unused.
std::optional<glm::ivec3> placesFor(size_t needed, const glm::ivec3& most) {
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
  if (least == 0) return std::nullopt;
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
Levels occupancy(const BrickLayout& layout) {
  Levels levels;
  levels.counts.push_back(layout.frame.brickCount);
  levels.full.emplace_back(layout.words.size());
  std::transform(layout.words.begin(), layout.words.end(), levels.full[0].begin(),
                 [](const glm::uvec2& word) { return static_cast<uint8_t>(!isEmpty(word)); });
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

using WordOfBrick = std::unordered_map<const float*, glm::uvec2>;

/// Shapes, packs and names the distinct bricks of a cut; nothing where they do not fit.
std::optional<WordOfBrick> placeBricks(const Cut& cut, int limitTexels, BrickLayout& layout) {
  std::vector<const float*> bricks;
  WordOfBrick words;
  for (const CutBrick& brick : cut.bricks)
    if (words.emplace(brick.samples, glm::uvec2(0u)).second) bricks.push_back(brick.samples);
  std::vector<SlotShape> shapes(bricks.size());
  tbb::parallel_for(size_t{0}, shapes.size(),
                    [&](size_t slot) { shapes[slot] = shapeOf(bricks[slot], layout.texel, layout.maximum); });
  std::vector<glm::ivec3> sizes;
  for (const SlotShape& shape : shapes) sizes.push_back(shape.size);
  const std::optional<Packing> packing = packBoxes(sizes, std::min<int>(limitTexels, kCornerMask + 1));
  if (!packing) return std::nullopt;
  layout.size = packing->size;
  for (const size_t slot : packing->order) {
    const SlotShape& shape = shapes[slot];
    layout.slots.push_back({bricks[slot], packing->corners[slot], shape.first, shape.size,
                            brick_bounds::bound(shape.maximumCode, layout.maximum)});
    words[bricks[slot]] = wordOf(layout.slots.back(), shape);
    if (layout.slabs.empty() || layout.slabs.back().z != packing->corners[slot].z)
      layout.slabs.push_back({packing->corners[slot].z, shape.size.z, layout.slots.size() - 1, 0});
    ++layout.slabs.back().slotCount;
  }
  return words;
}

/// Every brick's word over all of the frame that it stands for, and the largest empty cubes.
void writeWords(const Cut& cut, const WordOfBrick& words, BrickLayout& layout) {
  const glm::ivec3 count = layout.frame.brickCount;
  layout.words.assign(at(count, {0, 0, count.z}), glm::uvec2(0u));
  for (const CutBrick& brick : cut.bricks) {
    glm::uvec2 word = words.at(brick.samples);
    word.y |= static_cast<uint32_t>(brick.rise) << kLevelShift;
    const glm::ivec3 first = brick.brick * (1 << brick.rise) - layout.frame.brickMin;
    const glm::ivec3 last = glm::min(first + (1 << brick.rise), count);
    for (int z = first.z; z < last.z; ++z)
      for (int y = first.y; y < last.y; ++y)
        std::fill_n(layout.words.begin() + static_cast<std::ptrdiff_t>(at(count, {first.x, y, z})),
                    last.x - first.x, word);
    ++layout.bricksOfLevel[static_cast<size_t>(layout.frame.level + brick.rise)];
  }
  layout.stored = layout.words;
  const Levels levels = occupancy(layout);
  tbb::parallel_for(0, count.z, [&](int z) {
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x)
        if (glm::uvec2& word = layout.words[at(count, {x, y, z})]; isEmpty(word))
          word.y = emptyLevel(levels, {x, y, z});
  });
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

/// False where the light cache's textures would not hold them.
bool findBlocks(int limitTexels, BrickLayout& layout) {
  const glm::ivec3 bricks = layout.frame.brickCount;
  layout.blockCount = (bricks + kBlockBricks - 1) / kBlockBricks;
  const glm::ivec3 count = layout.blockCount;
  std::vector<uint8_t> full(at(count, {0, 0, count.z}), 0);
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x)
        if (!isEmpty(layout.words[at(bricks, {x, y, z})]))
          full[at(count, {x / kBlockBricks, y / kBlockBricks, z / kBlockBricks})] = 1;
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x)
        if (full[at(count, {x, y, z})] != 0) layout.blocks.emplace_back(x, y, z);
  const int mostXy = std::min(limitTexels / kMostBlockSamples, 1 << kBlockPlaceBits);
  const int mostZ = std::max(1, limitTexels / (kMostBlockSamples * kMostCachedLights));
  const std::optional<glm::ivec3> places = placesFor(layout.blocks.size(), {mostXy, mostXy, mostZ});
  if (!places) return false;
  layout.blockPlaces = *places;
  layout.blockWords.assign(full.size(), 0);
  const uint32_t nx = static_cast<uint32_t>(layout.blockPlaces.x),
                 ny = static_cast<uint32_t>(layout.blockPlaces.y);
  for (uint32_t i = 0; i < layout.blocks.size(); ++i)
    layout.blockWords[at(count, layout.blocks[i])] =
        1 + (i % nx | (i / nx % ny) << kBlockPlaceBits | (i / (nx * ny)) << (2 * kBlockPlaceBits));
  return true;
}

/// A layout at one resolution; nothing where it takes more than the options allow.
std::optional<BrickLayout> attempt(const BrickLevels& levels, const LayoutOptions& options) {
  const Cut cut = cutFor(levels, options.resolution);
  BrickLayout layout;
  layout.texel = options.texel;
  layout.frame = cut.frame;
  layout.mostRise = cut.mostRise;
  layout.pixels = options.resolution ? options.resolution->pixels : 0.0;
  if (cut.bricks.empty()) return layout;
  double maximum = 0.0;
  for (int rise = 0; rise <= cut.mostRise; ++rise)
    maximum = std::max(maximum, levels.at(cut.frame.level + rise).maximum);
  layout.maximum = static_cast<float>(maximum);
  if (layout.texel == Texel::r16f) layout.maximum = keptAs(layout.texel, layout.maximum, 0.0f);
  const auto words = placeBricks(cut, options.limitTexels, layout);
  if (!words) return std::nullopt;
  writeWords(cut, *words, layout);
  if (!findBlocks(options.limitTexels, layout)) return std::nullopt;
  const uint64_t bytes = layout.bytes() + options.blockBytes * layout.blocks.size();
  if (options.budgetBytes > 0 && bytes > options.budgetBytes) return std::nullopt;
  return layout;
}

}  // namespace

uint64_t BrickLayout::bytes() const {
  return bytesOf(texel) * static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y) *
             static_cast<uint64_t>(size.z) +
         sizeof(glm::uvec2) * words.size();
}

BrickLayout layOut(const BrickLevels& levels, const LayoutOptions& options) {
  LayoutOptions tried = options;
  constexpr double kLeastPixels = 0.5, kMostPixels = 1e4, kGrowth = 1.4142135623730951;
  do {
    if (std::optional<BrickLayout> layout = attempt(levels, tried)) return std::move(*layout);
    if (tried.resolution)
      tried.resolution->pixels = std::max(kLeastPixels, kGrowth * tried.resolution->pixels);
  } while (tried.resolution && tried.resolution->pixels < kMostPixels);
  const std::string voxels = std::to_string(levels.at(0).activeVoxels) + " voxels";
  if (options.budgetBytes > 0)
    throw InputError({levels.at(0).path}, "the grid's " + voxels + " do not fit into " +
                                              std::to_string(options.budgetBytes) +
                                              " bytes of GPU memory, even from its coarsest level");
  throw InputError({levels.at(0).path}, "the grid's " + voxels + " are more than 3-D textures of " +
                                            std::to_string(options.limitTexels) + " texels a side hold");
}

BrickLayout layOut(const BrickVolume& volume, const LayoutOptions& options) {
  NEPHELE_CHECK_EQ(options.resolution.has_value(), false);
  return layOut(BrickLevels(volume), options);
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
