// The stage for the march. Depends on scene, preview/stage_places.h,
// volume/bricks.h, volume/brick_layout.h and shaders/shared.
#pragma once

#include "preview/viewed_scene.h"
#include "shaders/shared/leaves.h"
#include "volume/brick_layout.h"
#include "volume/bricks.h"

namespace nephele {

/// Writes the rows of shaders/shared/stage_shapes.glsl; all 0 where the stage is off. Where its things stand:
/// preview/stage_places.h.
/// `frame` is that of the index which will be marched, a level of `bricks`.
void setStage(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
              const IndexFrame& frame);

}  // namespace nephele
