// What a picture gives up while it moves, so that it keeps its frame rate. Depends on scene alone.
#pragma once

#include <algorithm>

#include "scene/scene.h"

namespace nephele {

/// Share of a moving picture's frame that may go into filling the light cache, seconds.
inline constexpr double kMovingCacheSeconds = 0.012;

/// The march of a moving picture: longer steps, light from the cache alone, rays that end at a fiftieth.
/// Found by measurement on llvmpipe (bench/moving.cpp): of its 10% relative RMSE, half is the smaller
/// picture's edges.
inline MarchSettings movingMarch(MarchSettings march) {
  constexpr double kStepFactor = 3.0, kLeastStepVoxels = 2.0, kGiveUp = 0.02;
  march.stepVoxels = std::max(kLeastStepVoxels, kStepFactor * march.stepVoxels);
  march.shadowStepVoxels *= kStepFactor;
  march.cacheNearVoxels = 0.0;
  march.cacheNearSteps = 0;
  march.giveUp = std::max(march.giveUp, kGiveUp);
  march.adaptive = true;
  return march;
}

}  // namespace nephele
