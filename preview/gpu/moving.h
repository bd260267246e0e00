// What a picture gives up while it moves, so that it keeps its frame rate. Depends on scene alone.
#pragma once

#include <algorithm>

#include "scene/scene.h"

namespace nephele {

/// Share of a moving picture's frame that may go into filling the light cache, seconds.
inline constexpr double kMovingCacheSeconds = 0.012;

/// The march of a moving picture: longer steps, light from the cache alone, rays that end at a fiftieth. On
/// the default cumulus at half the window's sides, sharpened (gpu/sharpen.h), that differs by 4 to 10%
/// relative RMSE from its picture at rest, most with the sun behind it (bench/moving.cpp prints the figures).
/// `share`: of the resting picture's height, so that the light cache is the same for both.
inline MarchSettings movingMarch(MarchSettings march, double share) {
  constexpr double kLeastStepVoxels = 3.0, kGiveUp = 0.02;
  const double factor = std::max(1.0, kLeastStepVoxels / march.stepVoxels);
  march.stepVoxels *= factor;
  march.shadowStepVoxels *= factor;
  march.stepPixels *= share;
  march.cacheNearVoxels = 0.0;
  march.cacheNearSteps = 0;
  march.alwaysCached = true;
  march.giveUp = std::max(march.giveUp, kGiveUp);
  march.adaptive = true;
  return march;
}

}  // namespace nephele
