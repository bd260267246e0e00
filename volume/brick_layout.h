// How bricks lie in an atlas and what the index says of each: the GPU and the march compiled as C++ read the
// same. Depends on the brick headers alone; no OpenVDB and no GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "volume/brick_bounds.h"
#include "volume/brick_cut.h"
#include "volume/brick_texel.h"
#include "volume/bricks.h"

namespace nephele {

/// Two words a brick. x: bits 0–11 and 12–23 are the texel x and y of its first sample in the atlas, bits
/// 24–31 the code of its maximum (brick_bounds). Where that is 0 the brick holds no density, and y is the
/// largest L for which the aligned cube of 2^L bricks an edge around it (aligned to its corner, and cut at
/// the index's end) holds none either. Else y: bits 0–11 are the texel z; bits 12–14 say along which axes it
/// keeps 5 samples instead of 9, and bits 15–17 whether those are its upper ones: beyond them all is 0; bits
/// 18–20 its level above the frame's; bits 24–31 the share of the maximum that no sample falls below.
namespace brick_word {
inline constexpr uint32_t kCornerBits = 12, kCornerMask = (1u << kCornerBits) - 1, kMaximumShift = 24,
                          kMinimumShift = 24, kHalvedShift = 12, kUpperShift = 15, kLevelShift = 18,
                          kLevelMask = 7;

inline bool isEmpty(const glm::uvec2& word) { return word.x >> kMaximumShift == 0; }
inline uint32_t maximumCode(const glm::uvec2& word) { return word.x >> kMaximumShift; }
/// First texel in the atlas.
inline glm::ivec3 corner(const glm::uvec2& word) {
  return {static_cast<int>(word.x & kCornerMask), static_cast<int>(word.x >> kCornerBits & kCornerMask),
          static_cast<int>(word.y & kCornerMask)};
}
}  // namespace brick_word

/// Samples along an axis of which a brick keeps half: its 4 cells, and the next brick's first sample.
inline constexpr int kHalfSamples = kBrickCells / 2 + 1;

/// Bricks along the edge of a block of the light cache.
inline constexpr int kBlockBricks = 2;
/// The light cache may hold so many samples along a block's edge, for so many lights.
inline constexpr int kMostBlockSamples = kBlockBricks * kBrickCells + 1;
inline constexpr int kMostCachedLights = 8;

/// One brick of the atlas.
struct BrickSlot {
  const float* samples = nullptr;  // all 729, the volume's own
  glm::ivec3 corner{0};            // first texel
  glm::ivec3 first{0};             // first sample that is kept, 0 or 4 along each axis
  glm::ivec3 size{kBrickSamples};  // samples that are kept, 9 or 5
  float scale = 0.0f;              // of an r8 texel: the bound that its maximum's code stands for
};

/// Slots whose texels fill whole planes of the atlas: they are uploaded together.
struct AtlasSlab {
  int z = 0, thickness = 0;             // texels
  size_t firstSlot = 0, slotCount = 0;  // in BrickLayout::slots
};

/// Where every brick goes.
struct BrickLayout {
  Texel texel = Texel::r32f;
  IndexFrame frame;                // what the index covers
  int mostRise = 0;                // levels that the coarsest brick lies above the frame's
  glm::ivec3 size{1};              // of the atlas, texels
  float maximum = 0.0f;            // no sample exceeds it; codes of maxima are shares of it
  std::vector<glm::uvec2> words;   // x fastest, as BrickVolume::index
  std::vector<glm::uvec2> stored;  // the same of bricks with density alone; 0 elsewhere
  std::vector<BrickSlot> slots;    // in the order of their places
  std::vector<AtlasSlab> slabs;
  double pixels = 0.0;  // that voxels may cover; 0: every brick comes from the finest level
  std::array<size_t, BrickLevels::kMost + 1> bricksOfLevel{};  // bricks with density, by level
  glm::ivec3 blockCount{0};                                    // blocks of the light cache along each axis
  std::vector<glm::ivec3> blocks;  // those that hold a brick with density, x fastest
  glm::ivec3 blockPlaces{1};       // size of the cache's atlas in blocks, along each axis
  std::vector<uint32_t>
      blockWords;  // per block, x fastest: 0, or 1 + its place, 10 bits an axis; in order of `blocks`

  /// Of atlas and index.
  uint64_t bytes() const;
  /// Whether texels are shares of their brick's bound.
  bool scaled() const { return texel == Texel::r8; }
};

/// What textures can hold, texels along an axis; 2048 is the least that OpenGL 4.5 promises.
inline constexpr int kLeastTextureLimit = 2048;

struct LayoutOptions {
  Texel texel = Texel::r32f;
  int limitTexels = kLeastTextureLimit;
  std::optional<Resolution> resolution;  // none: every brick from the finest level
  uint64_t budgetBytes = 0;              // of atlas, index and light cache; 0: no limit
  uint64_t blockBytes = 0;               // that a block of the light cache takes
};

/// Lays a volume, which must outlive the layout, out in an atlas of at most `limitTexels` an axis (and what a
/// word can tell). A brick whose density lies in one half of it along an axis keeps that half. Where a
/// resolution is given and the bricks that it asks for take more than the textures or the budget hold, they
/// come from coarser levels, as if voxels might cover √2, 2, … times as many pixels (BrickLayout::pixels).
/// Throws InputError where nothing helps. An empty volume has one texel and no words.
BrickLayout layOut(const BrickLevels& levels, const LayoutOptions& options);
/// The same without coarser levels.
BrickLayout layOut(const BrickVolume& volume, const LayoutOptions& options = {});

/// Writes the texels of a slab, x fastest, size.x · size.y · thickness of them, of bytesOf(layout.texel)
/// each; what no brick uses is 0.
void writeSlab(const BrickLayout& layout, const AtlasSlab& slab, std::vector<std::byte>& texels);

/// What a texture of such texels gives for each of them, without a brick's scale; `values` has room for all.
void readTexels(Texel texel, const std::vector<std::byte>& texels, float* values);

}  // namespace nephele
