// The stage for the march: places that a scene leaves open follow from the cloud. Depends on scene,
// volume/bricks.h, volume/brick_layout.h and shaders/shared.
#pragma once

#include "preview/viewed_scene.h"
#include "shaders/shared/leaves.h"
#include "volume/brick_layout.h"
#include "volume/bricks.h"

namespace nephele {

/// Writes the rows of shaders/shared/stage_shapes.glsl; all 0 where the stage is off. A floor lies a little
/// below the cloud, balls and cube stand on it before the cloud (as seen along skyAxes' forward), their sizes
/// shares of half the cloud's longest side. An empty volume counts as a cloud of half side 1.
/// `frame` is that of the index which will be marched, a level of `bricks`.
void setStage(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
              const IndexFrame& frame);

}  // namespace nephele
