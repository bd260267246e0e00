// Places of the stage. Depends on what its header names.
#include "preview/gpu/stage_parameters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

#include "scene/sky.h"

namespace nephele {
namespace {

using glm::dvec3;
using glm::vec4;

// Of half the cloud's longest side.
constexpr double kFloorBelow = 0.12, kFloorRadius = 6.0, kChecker = 0.5;
// Where a thing stands, to the right of the cloud's middle and towards the viewer, and its radius or half
// edge.
struct Spot {
  double across, towards, size;
};
constexpr Spot kChromeSpot{-0.8, 1.15, 0.3}, kGreySpot{0.95, 1.0, 0.24}, kCubeSpot{0.1, 1.5, 0.18};

vec4 row(const dvec3& v, double w) { return vec4(glm::vec3(v), static_cast<float>(w)); }

/// Corner of the brick grid that is marched, in voxels of the finest level.
dvec3 cornerOf(const IndexFrame& frame) {
  return std::ldexp(1.0, frame.level) * dvec3(frame.brickMin * kBrickCells);
}

/// The cloud's active box along the stage's axes (right, away, up), relative to the brick grid's corner.
struct Extent {
  dvec3 low, high;
};

Extent extentOf(const BrickVolume& bricks, const dvec3& base, const glm::dmat3& axes) {
  if (bricks.empty()) return {dvec3(-1.0), dvec3(1.0)};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent extent{dvec3(kFar), dvec3(-kFar)};
  for (int corner = 0; corner < 8; ++corner) {
    dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = ((corner >> axis & 1) != 0 ? bricks.activeMax : bricks.activeMin)[axis] - base[axis];
    const dvec3 place = glm::dmat3(bricks.worldFromIndex) * index;
    const dvec3 along(glm::dot(place, axes[0]), glm::dot(place, axes[1]), glm::dot(place, axes[2]));
    extent.low = glm::min(extent.low, along);
    extent.high = glm::max(extent.high, along);
  }
  return extent;
}

}  // namespace

void setStage(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
              const IndexFrame& frame) {
  const Stage& stage = view.scene.stage;
  if (!stage.on) return;
  const SkyAxes sky = skyAxes(view.up, 0.0);
  const glm::dmat3 axes(sky.right, sky.forward, sky.up);
  const Extent extent = extentOf(bricks, cornerOf(frame), axes);
  const dvec3 corner(bricks.worldFromIndex * glm::dvec4(cornerOf(frame), 1.0));
  const dvec3 sides = extent.high - extent.low, middle = 0.5 * (extent.low + extent.high);
  const double size = 0.5 * std::max({sides.x, sides.y, sides.z});
  const double height =
      stage.height ? *stage.height - glm::dot(corner, sky.up) : extent.low.z - kFloorBelow * size;
  const dvec3 ground = axes * dvec3(middle.x, middle.y, height);
  double bound = stage.floor ? kFloorRadius * size : 0.0;
  const auto place = [&](const StageThing& thing, const Spot& spot, double sizePerRow) {
    if (!thing.on) return vec4(0.0f);
    const double half = thing.size ? *thing.size * sizePerRow : spot.size * size;
    const dvec3 centre = thing.center ? *thing.center - corner
                                      : ground + axes * dvec3(spot.across * size, -spot.towards * size, half);
    constexpr double kCorner = 1.7320508075688772;  // of a cube, in half edges
    bound = std::max(bound, glm::distance(centre, ground) + kCorner * half);
    return row(centre, half);
  };
  p.stageChrome = place(stage.chrome, kChromeSpot, 1.0);
  p.stageGrey = place(stage.grey, kGreySpot, 1.0);
  p.stageCube = place(stage.cube, kCubeSpot, 0.5);
  p.stageFloor = row(ground, stage.floor ? kFloorRadius * size : 0.0);
  p.stageUp = row(sky.up, stage.checker.value_or(kChecker * size));
  p.stageAcross = row(sky.right, 0.0);
  constexpr double kRoom = 1.05;  // the floor has a thickness
  p.stage = row(dvec3(kRoom * bound, stage.penumbra, stage.highlights ? 1.0 : 0.0), size);
}

}  // namespace nephele
