// Places of the stage. Depends on what its header names.
#include "preview/gpu/stage_places.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

namespace nephele {
namespace {

using glm::dvec3;

// Of half the cloud's longest side.
constexpr double kFloorBelow = 0.12, kFloorRadius = 6.0, kChecker = 0.5;
// Where a thing stands, to the right of the cloud's middle and towards the viewer, and its radius or half
// edge.
struct Spot {
  double across, towards, size;
};
constexpr Spot kChromeSpot{-0.8, 1.15, 0.3}, kGreySpot{0.95, 1.0, 0.24}, kCubeSpot{0.1, 1.5, 0.18};

/// The cloud's active box along the stage's axes (right, away, up), relative to `from`.
struct Extent {
  dvec3 low, high;
};

Extent extentOf(const BrickVolume& bricks, const dvec3& from, const glm::dmat3& axes) {
  if (bricks.empty()) return {dvec3(-1.0), dvec3(1.0)};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent extent{dvec3(kFar), dvec3(-kFar)};
  for (int corner = 0; corner < 8; ++corner) {
    dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = ((corner >> axis & 1) != 0 ? bricks.activeMax : bricks.activeMin)[axis];
    const dvec3 place = dvec3(bricks.worldFromIndex * glm::dvec4(index, 1.0)) - from;
    const dvec3 along(glm::dot(place, axes[0]), glm::dot(place, axes[1]), glm::dot(place, axes[2]));
    extent.low = glm::min(extent.low, along);
    extent.high = glm::max(extent.high, along);
  }
  return extent;
}

}  // namespace

StagePlaces placesOf(const Stage& stage, const dvec3& up, const BrickVolume& bricks, const dvec3& from) {
  StagePlaces places;
  places.axes = skyAxes(up, 0.0);
  const glm::dmat3 axes(places.axes.right, places.axes.forward, places.axes.up);
  const Extent extent = extentOf(bricks, from, axes);
  const dvec3 sides = extent.high - extent.low, middle = 0.5 * (extent.low + extent.high);
  places.size = 0.5 * std::max({sides.x, sides.y, sides.z});
  const double height = stage.height ? *stage.height - glm::dot(from, places.axes.up)
                                     : extent.low.z - kFloorBelow * places.size;
  places.ground = axes * dvec3(middle.x, middle.y, height);
  places.floorRadius = kFloorRadius * places.size;
  places.checker = stage.checker.value_or(kChecker * places.size);
  const auto place = [&](const StageThing& thing, const Spot& spot, double halfPerSize) {
    const double half = thing.size ? *thing.size * halfPerSize : spot.size * places.size;
    const dvec3 standing(spot.across * places.size, -spot.towards * places.size, half);
    return StagePlace{thing.center ? *thing.center - from : places.ground + axes * standing, half};
  };
  places.chrome = place(stage.chrome, kChromeSpot, 1.0);
  places.grey = place(stage.grey, kGreySpot, 1.0);
  places.cube = place(stage.cube, kCubeSpot, 0.5);
  return places;
}

}  // namespace nephele
