// How bricks lie in an atlas and what a word of the index says of each: the GPU and the march compiled as C++
// read the same. Depends on volume/bricks.h alone; no OpenVDB and no GL.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "volume/bricks.h"

namespace nephele {

/// One word a brick. Below 2^27 the brick holds no density, and the word is the largest L for which the
/// aligned cube of 2^L bricks an edge around the brick (aligned to brickMin, and cut at the index's end)
/// holds none either. Else bits 0–7, 8–15, 16–22 are the brick's place in the atlas along x, y, z; bits 23–24
/// its level; bits 25–26 say by what share of its maximum its minimum is at least (kMinimumShares); bits
/// 27–31 are c in 1…31: no sample exceeds `maximum` · 2^((c − 31)/2), the least such c.
namespace brick_word {
inline constexpr int kPlaceShiftY = 8, kPlaceShiftZ = 16, kLevelShift = 23, kMinimumShift = 25,
                     kMaximumShift = 27;
inline constexpr uint32_t kPlaceMask = 255, kPlaceMaskZ = 127, kLevelMask = 3, kMinimumMask = 3;
inline constexpr uint32_t kFirstFull = 1u << kMaximumShift;
inline constexpr int kMostCode = 31;
inline constexpr float kMinimumShares[] = {0.0f, 0.5f, 0.875f, 1.0f};

inline bool isEmpty(uint32_t word) { return word < kFirstFull; }
inline glm::ivec3 place(uint32_t word) {
  return {static_cast<int>(word & kPlaceMask), static_cast<int>(word >> kPlaceShiftY & kPlaceMask),
          static_cast<int>(word >> kPlaceShiftZ & kPlaceMaskZ)};
}
/// The code c of the smallest bound that `value` does not exceed; value in (0, maximum].
uint32_t maximumCode(float value, float maximum);
/// The largest of the four shares that minimum/maximum reaches.
uint32_t minimumCode(float minimum, float maximum);
}  // namespace brick_word

/// Bricks along the edge of a block of the light cache.
inline constexpr int kBlockBricks = 2;
/// The light cache may hold so many samples along a block's edge, for so many lights.
inline constexpr int kMostBlockSamples = kBlockBricks * kBrickCells + 1;
inline constexpr int kMostCachedLights = 8;

/// Where every brick goes.
struct BrickLayout {
  glm::ivec3 brickCount{0};     // as the volume's
  glm::ivec3 places{1};         // size of the atlas in bricks, along each axis
  std::vector<uint32_t> words;  // x fastest, as BrickVolume::index
  std::vector<const float*>
      bricks;                      // the 729 samples at each place, places in order x, y, z; the volume's own
  glm::ivec3 blockCount{0};        // blocks of the light cache along each axis
  std::vector<glm::ivec3> blocks;  // those that hold a brick with density, x fastest
  glm::ivec3 blockPlaces{1};       // size of the cache's atlas in blocks, along each axis
  std::vector<uint32_t>
      blockWords;  // per block, x fastest: 0, or 1 + its place, 10 bits an axis; in order of `blocks`
};

/// What textures can hold, texels along an axis; 2048 is the least that OpenGL 4.5 promises.
inline constexpr int kLeastTextureLimit = 2048;

/// Lays a volume, which must outlive the layout, out in an atlas of at most `limitTexels` an axis (and what a
/// word can tell). Throws InputError where it has more bricks than that. An empty volume has one place and no
/// words.
BrickLayout layOut(const BrickVolume& volume, int limitTexels = kLeastTextureLimit);

}  // namespace nephele
