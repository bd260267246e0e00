// From a scene in world space to the march's parameters in index space, in double precision until the last
// rounding. Depends on scene, volume/bricks.h and shaders/shared.
#pragma once

#include "preview/viewed_scene.h"
#include "shaders/shared/leaves.h"
#include "volume/brick_cut.h"
#include "volume/brick_layout.h"

namespace nephele {

/// Everything the march is told for a picture of width × height pixels. Rays start on a plane across the
/// camera's axis in front of the medium's support, and coordinates are voxels from the corner of the brick
/// grid: neither a far camera nor a medium far from the origin costs precision. Any affine worldFromIndex.
/// `randomStart`: steps start at random instead of midway. Throws InputError for more than kMaxLights lights,
/// and for a camera without a direction (target at position, or up along the view).
/// `frame` is that of the index which will be marched (BrickLayout::frame), a level of `bricks`; without one,
/// of the finest.
shared::MarchParameters marchParameters(const ViewedScene& view, const BrickVolume& bricks,
                                        const IndexFrame& frame, int width, int height, unsigned seed,
                                        bool randomStart);
shared::MarchParameters marchParameters(const ViewedScene& view, const BrickVolume& bricks, int width,
                                        int height, unsigned seed, bool randomStart);

/// How finely a picture of that height tells voxels apart, where they may cover `pixels`.
Resolution resolutionOf(const Camera& camera, const BrickVolume& bricks, int height, double pixels = 1.0);

/// The direction, unit and in the world, of the ray through picture position (x, y), pixels from the top left
/// corner. Throws as marchParameters does for a camera without a direction.
glm::dvec3 viewDirection(const Camera& camera, int width, int height, double x, double y);

}  // namespace nephele
