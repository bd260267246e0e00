// The terms of the light as the march's parameters. Depends on scene, volume/bricks.h and shaders/shared.
#pragma once

#include "preview/viewed_scene.h"
#include "shaders/shared/leaves.h"
#include "volume/brick_cut.h"

namespace nephele {

/// Sets medium, phase, powder, chord, octaves and environment of `p`: what lightModelOf says is on, in index
/// space where places are meant. An empty volume gets heights and an ellipsoid of no extent, which no ray
/// asks for. Index space is that of `frame`, a level of `bricks`. The smallest transmittance worth following,
/// environment.w, stays.
void setLightParameters(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
                        const IndexFrame& frame);

}  // namespace nephele
