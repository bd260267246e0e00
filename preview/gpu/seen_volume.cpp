// Making and keeping atlases. Depends on what its header names, gpu/camera_rays.h and gpu/light_cache.h.
#include "preview/gpu/seen_volume.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "preview/gpu/camera_rays.h"
#include "preview/gpu/film.h"
#include "preview/gpu/light_cache.h"
#include "preview/gpu/moving.h"

namespace nephele {

Texel texelFor(AtlasPrecision precision, const BrickVolume& bricks) {
  switch (precision) {
    case AtlasPrecision::r8:
      return Texel::r8;
    case AtlasPrecision::r16f:
      return Texel::r16f;
    case AtlasPrecision::r32f:
      return Texel::r32f;
    case AtlasPrecision::automatic:
      break;
  }
  return chooseTexel(bricks);
}

bool SeenVolume::serves(const Kept& kept, const Resolution& resolution, AtlasPrecision precision,
                        bool moving) const {
  if (!kept.atlas || kept.precision != precision || kept.asked.pixels != resolution.pixels) return false;
  if (moving) return true;
  const BrickLayout& layout = kept.atlas->layout();
  const glm::dvec3 low(bricks_.activeMin - 1), high(bricks_.activeMax);
  if (levelFor(resolution, bricks_.worldFromIndex, low, high) != layout.frame.level) return false;
  // Bricks of several levels are right for one place alone; a little beside it they are nearly so.
  constexpr double kNearly = 0.1;
  const double distance = glm::distance(resolution.eye, glm::clamp(resolution.eye, low, high));
  const double moved = glm::distance(resolution.eye, kept.asked.eye);
  const double zoomed = std::abs(resolution.pixelsPerRadian / kept.asked.pixelsPerRadian - 1.0);
  const bool mixed = layout.mostRise > 0 || layout.pixels > resolution.pixels;
  return !mixed || (moved <= kNearly * distance && zoomed <= kNearly);
}

std::shared_ptr<const BrickAtlas> SeenVolume::make(const ViewedScene& view, int width, int height) {
  LayoutOptions options;
  options.texel = texelFor(view.scene.march.precision, bricks_);
  options.limitTexels = volumeTextureLimit();
  if (limits_.texels > 0) options.limitTexels = std::min(options.limitTexels, limits_.texels);
  options.resolution = resolutionOf(view.camera, bricks_, height, view.scene.march.levelPixels);
  ViewedScene counted = view;
  if (moves_)
    counted.scene.march = movingMarch(counted.scene.march, 1.0);  // asks for all that one at rest asks for
  // Which voxels the bricks will have is not known yet: at most so many bytes.
  counted.scene.march.stepPixels = 0.0;
  options.blockBytes =
      LightCache::blockBytes(filter_, marchParameters(counted, bricks_, width, height, 0, false));
  if (!heat_) heat_ = atlasOfTemperatures(bricks_, filter_);
  if (limits_.bytes > 0) {
    // A moving picture takes one more at most: of all pixels, or a quarter of them twice, sharpened.
    const uint64_t films = (moves_ ? 2 : 1) * Film::bytesFor(width, height);
    const uint64_t taken = films + (heat_ ? heat_->gpuBytes() : 0);
    if (taken >= limits_.bytes)
      throw InputError({}, "--vram: the picture's " + std::to_string(taken) +
                               " bytes (and its temperatures') leave none for the bricks");
    options.budgetBytes = limits_.bytes - taken;
  }
  return std::make_shared<const BrickAtlas>(layOut(levels_, options), heat_, filter_);
}

const BrickAtlas& SeenVolume::atlasFor(size_t which, const ViewedScene& view, int width, int height,
                                       bool moving) {
  const Resolution resolution = resolutionOf(view.camera, bricks_, height, view.scene.march.levelPixels);
  const AtlasPrecision precision = view.scene.march.precision;
  Kept& kept = kept_[which];
  const auto fits = [&](const Kept& k) { return serves(k, resolution, precision, moving); };
  if (fits(kept)) return *kept.atlas;
  kept = {};  // before the next, that memory suffices
  const auto other = std::find_if(kept_.begin(), kept_.end(), fits);
  kept = other != kept_.end() ? *other : Kept{precision, resolution, make(view, width, height)};
  return *kept.atlas;
}

uint64_t SeenVolume::gpuBytes() const {
  uint64_t bytes = 0;
  for (size_t i = 0; i < kPictures; ++i)
    if (kept_[i].atlas && (i == 0 || kept_[i].atlas != kept_[0].atlas)) bytes += kept_[i].atlas->gpuBytes();
  return bytes;
}

}  // namespace nephele
