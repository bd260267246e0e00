// Making and keeping atlases. Depends on what its header names.
#include "preview/gpu/seen_volume.h"

#include <algorithm>

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

const BrickAtlas& SeenVolume::atlasFor(size_t which, const MarchSettings& march) {
  Kept& kept = kept_[which];
  const auto fits = [&](const Kept& k) { return k.atlas && k.precision == march.precision; };
  if (fits(kept)) return *kept.atlas;
  kept = {};  // before the next, that memory suffices
  const auto other = std::find_if(kept_.begin(), kept_.end(), fits);
  if (other != kept_.end())
    kept = *other;
  else
    kept = {march.precision,
            std::make_shared<const BrickAtlas>(bricks_, filter_, texelFor(march.precision, bricks_))};
  return *kept.atlas;
}

uint64_t SeenVolume::gpuBytes() const {
  uint64_t bytes = 0;
  for (size_t i = 0; i < kPictures; ++i)
    if (kept_[i].atlas && (i == 0 || kept_[i].atlas != kept_[0].atlas)) bytes += kept_[i].atlas->gpuBytes();
  return bytes;
}

}  // namespace nephele
