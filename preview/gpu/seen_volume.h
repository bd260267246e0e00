// A volume on the GPU as pictures of it need it: in the precision that their scene asks for, no finer than
// they can show, and within a limit of memory. Depends on scene and gpu/brick_atlas.h.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "preview/gpu/brick_atlas.h"
#include "preview/viewed_scene.h"
#include "volume/brick_levels.h"

namespace nephele {

/// What the GPU may be asked for.
struct GpuLimits {
  uint64_t bytes = 0;  // bricks, index, light cache and film; 0: as much as there is
  int texels = 0;  // of a 3-D texture along an axis, where that is less than the driver's; 0: the driver's
};

/// The texel that a scene's precision means for a volume: the smallest that is as good where it is automatic.
Texel texelFor(AtlasPrecision precision, const BrickVolume& bricks);

/// Keeps the atlases of up to two pictures of a volume (the sides of a split), one where they agree.
class SeenVolume {
 public:
  static constexpr size_t kPictures = 2;

  /// The bricks must outlive it. Uploads nothing yet. `moves`: memory is kept for pictures that move
  /// (gpu/moving.h) beside those at rest.
  SeenVolume(const BrickVolume& bricks, Filter filter, const GpuLimits& limits = {}, bool moves = false)
      : bricks_(bricks), levels_(bricks), filter_(filter), limits_(limits), moves_(moves) {}

  /// The atlas for picture `which`, of width × height pixels; made where none is, or none that shows what
  /// this view can tell apart. `moving`: any that is there will do. Throws as BrickAtlas does, and InputError
  /// where the limits are too small for any level.
  const BrickAtlas& atlasFor(size_t which, const ViewedScene& view, int width, int height, bool moving);
  void forget(size_t which) { kept_[which] = {}; }
  uint64_t gpuBytes() const;
  /// nullopt where there is no atlas for that picture yet.
  std::optional<Texel> texelOf(size_t which) const {
    return kept_[which].atlas ? std::optional(kept_[which].atlas->layout().texel) : std::nullopt;
  }

 private:
  struct Kept {
    AtlasPrecision precision = AtlasPrecision::automatic;
    Resolution asked;  // that its levels were chosen for
    std::shared_ptr<const BrickAtlas> atlas;
  };
  bool serves(const Kept& kept, const Resolution& resolution, AtlasPrecision precision, bool moving) const;
  std::shared_ptr<const BrickAtlas> make(const ViewedScene& view, int width, int height);

  const BrickVolume& bricks_;
  BrickLevels levels_;
  Filter filter_;
  GpuLimits limits_;
  bool moves_;
  std::shared_ptr<const BrickAtlas> heat_;
  std::array<Kept, kPictures> kept_;
};

}  // namespace nephele
