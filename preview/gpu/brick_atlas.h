// The brick arrays on the GPU: an atlas of bricks and an index that says where each brick lies in it.
// Depends on volume/bricks.h, volume/brick_layout.h and gpu/gl.h.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "preview/filter.h"
#include "preview/gpu/gl.h"
#include "volume/brick_layout.h"
#include "volume/bricks.h"

namespace nephele {

/// Makes a 2-D texture (R32UI, RG32UI) of texels of one or two words, one after the other in rows of a power
/// of two, and adds its bytes. An index by 3-D textures would end where they do. Throws InputError where the
/// driver's 2-D textures do not hold them.
GlTexture makeIndexTexture(std::span<const uint32_t> words, int channels, uint64_t& gpuBytes);

/// The most texels that the driver's 3-D textures have along an axis.
int volumeTextureLimit();

/// Sets how a 3-D texture is read between texels; beyond its faces it goes on as at them.
void setVolumeFilter(GLuint texture, Filter filter);

class BrickAtlas;
/// The temperatures of a volume on the GPU; nullptr where it has none.
std::shared_ptr<const BrickAtlas> atlasOfTemperatures(const BrickVolume& bricks, Filter filter);

/// The volume laid out (volume/brick_layout.h) in two textures: a 3-D atlas and the index's words.
class BrickAtlas {
 public:
  /// Uploads all bricks, their samples kept as `texel`, and those of its temperatures, which must outlive it.
  /// Throws InputError where the grid has more bricks than the driver's textures hold, and WorldError where
  /// the GPU's memory does not suffice. An empty volume makes textures of one brick and one word.
  BrickAtlas(const BrickVolume& bricks, Filter filter, Texel texel);
  /// The same of a layout that is made already; `heat` is the atlas of its temperatures, or nullptr.
  BrickAtlas(BrickLayout layout, std::shared_ptr<const BrickAtlas> heat, Filter filter);

  /// Binds the atlas to texture unit 0 and the index to unit 1; temperatures to units 10 and 11.
  void bind() const;
  /// Binds the index of what is stored, without empty cubes, to unit 12; uploads it when first asked.
  void bindStored() const;
  Filter filter() const { return filter_; }
  uint64_t gpuBytes() const { return gpuBytes_ + storedBytes_; }
  const BrickLayout& layout() const { return layout_; }
  /// Differs from that of every other atlas of this process.
  uint64_t serial() const { return serial_; }

  /// For who writes densities on the GPU: the textures, and the word that what is made from their contents is
  /// old.
  GLuint texture() const { return atlas_.name(); }
  GLuint indexTexture() const { return index_.name(); }
  /// No density exceeds `bound`, which codes in the index are shares of.
  void contentsChanged(float bound) {
    ++contents_;
    layout_.maximum = bound;
  }
  /// Counts those changes.
  uint64_t contents() const { return contents_; }

 private:
  void uploadAtlas();

  Filter filter_;
  BrickLayout layout_;
  GlTexture atlas_;
  GlTexture index_;
  std::shared_ptr<const BrickAtlas> heat_;  // of the volume's temperatures, where it has some
  mutable GlTexture stored_;
  mutable uint64_t storedBytes_ = 0;
  uint64_t gpuBytes_ = 0;
  uint64_t serial_;
  uint64_t contents_ = 0;
};

}  // namespace nephele
