// A volume on the GPU as pictures of it need it: in the precision that their scene asks for. Depends on scene
// and gpu/brick_atlas.h.
#pragma once

#include <array>
#include <memory>

#include "preview/gpu/brick_atlas.h"
#include "preview/viewed_scene.h"

namespace nephele {

/// The texel that a scene's precision means for a volume: the smallest that is as good where it is automatic.
Texel texelFor(AtlasPrecision precision, const BrickVolume& bricks);

/// Keeps the atlases of up to two pictures of a volume (the sides of a split), one where they agree.
class SeenVolume {
 public:
  static constexpr size_t kPictures = 2;

  /// The bricks must outlive it. Uploads nothing yet.
  SeenVolume(const BrickVolume& bricks, Filter filter) : bricks_(bricks), filter_(filter) {}

  /// The atlas for picture `which` under these settings; made where none is. Throws as BrickAtlas does.
  const BrickAtlas& atlasFor(size_t which, const MarchSettings& march);
  void forget(size_t which) { kept_[which] = {}; }
  uint64_t gpuBytes() const;

 private:
  struct Kept {
    AtlasPrecision precision = AtlasPrecision::automatic;
    std::shared_ptr<const BrickAtlas> atlas;
  };
  const BrickVolume& bricks_;
  Filter filter_;
  std::array<Kept, kPictures> kept_;
};

}  // namespace nephele
