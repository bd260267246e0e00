// The brick arrays on the GPU: an atlas of 9³ bricks and an index that says where each brick lies in it.
// Depends on volume/bricks.h and gpu/gl.h.
#pragma once

#include <cstdint>

#include "preview/filter.h"
#include "preview/gpu/gl.h"
#include "volume/bricks.h"

namespace nephele {

/// Two 3-D textures. The atlas (R32F) holds slot s at bricks (s mod nx, s/nx mod ny, s/(nx ny)); the index
/// (R32UI) holds 0 for no density, else bit 24 and the brick's place, 8 bits an axis.
class BrickAtlas {
 public:
  /// Uploads all bricks. Throws InputError where the grid is longer than the driver's 3-D textures allow, and
  /// WorldError where the GPU's memory does not suffice. An empty volume makes textures of one texel.
  BrickAtlas(const BrickVolume& bricks, Filter filter);

  /// Binds the atlas to texture unit 0 and the index to unit 1.
  void bind() const;
  glm::ivec3 sizeTexels() const { return sizeTexels_; }
  uint64_t gpuBytes() const { return gpuBytes_; }

 private:
  void uploadAtlas(const BrickVolume& bricks, const glm::ivec3& places);
  void uploadIndex(const BrickVolume& bricks, const glm::ivec3& places);

  GlTexture atlas_;
  GlTexture index_;
  glm::ivec3 sizeTexels_{1};
  uint64_t gpuBytes_ = 0;
};

}  // namespace nephele
