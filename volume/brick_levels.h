// Coarser versions of a volume, each half as fine as the one before, made when they are asked for. Depends on
// volume/bricks.h; no OpenVDB and no GL.
#pragma once

#include <array>
#include <memory>

#include "volume/bricks.h"

namespace nephele {

/// The volume at half its resolution: sample i lies where sample 2 i of the finer one does and is the mean of
/// it and its 26 neighbours, weighted (1/4, 1/2, 1/4) along each axis. So the integral of the trilinear
/// density is the same, and no sample exceeds the finer one's maximum. The support grows by up to two finer
/// voxels to all sides. Active voxels, their mean and notes are left as the finer volume has them;
/// temperatures too.
BrickVolume coarser(const BrickVolume& finer);

/// A volume and its coarser versions. Not thread-safe: levels are made when first asked for.
class BrickLevels {
 public:
  /// Words of the index tell levels 0 to 7 apart.
  static constexpr int kMost = 7;

  /// The volume must outlive it.
  explicit BrickLevels(const BrickVolume& finest) : finest_(finest) {}
  /// Level 0 is the volume itself. 0 ≤ level ≤ kMost.
  const BrickVolume& at(int level) const;

 private:
  const BrickVolume& finest_;
  mutable std::array<std::unique_ptr<const BrickVolume>, kMost> coarser_;
};

}  // namespace nephele
