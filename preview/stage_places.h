// Where the stage's floor and things stand: places and sizes that a scene leaves open follow from the cloud.
// Every renderer of the stage reads this one. Depends on scene and volume/bricks.h.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>

#include "scene/sky.h"
#include "scene/stage.h"
#include "volume/bricks.h"

namespace nephele {

/// A thing's centre, relative to where placesOf was told, and its radius or half edge; world units.
struct StagePlace {
  glm::dvec3 centre{0.0};
  double half = 0.0;
};

struct StagePlaces {
  SkyAxes axes;
  glm::dvec3 ground{0.0};  // on the floor, below the cloud's middle; relative as above
  double size = 1.0;       // half the cloud's longest side
  double floorRadius = 0.0, checker = 0.0;
  StagePlace chrome, grey, cube;  // also where they are off
};

namespace stage_spots {

// Of half the cloud's longest side.
inline constexpr double kFloorBelow = 0.12, kFloorRadius = 6.0, kChecker = 0.5;
// Where a thing stands, to the right of the cloud's middle and towards the viewer, and its radius or half
// edge.
struct Spot {
  double across, towards, size;
};
inline constexpr Spot kChromeSpot{-0.8, 1.15, 0.3}, kGreySpot{0.95, 1.0, 0.24}, kCubeSpot{0.1, 1.5, 0.18};

/// The cloud's active box along the stage's axes (right, away, up), relative to `from`.
struct Extent {
  glm::dvec3 low, high;
};

inline Extent extentOf(const BrickVolume& bricks, const glm::dvec3& from, const glm::dmat3& axes) {
  if (bricks.empty()) return {glm::dvec3(-1.0), glm::dvec3(1.0)};
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent extent{glm::dvec3(kFar), glm::dvec3(-kFar)};
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = ((corner >> axis & 1) != 0 ? bricks.activeMax : bricks.activeMin)[axis];
    const glm::dvec3 place = glm::dvec3(bricks.worldFromIndex * glm::dvec4(index, 1.0)) - from;
    const glm::dvec3 along(glm::dot(place, axes[0]), glm::dot(place, axes[1]), glm::dot(place, axes[2]));
    extent.low = glm::min(extent.low, along);
    extent.high = glm::max(extent.high, along);
  }
  return extent;
}

}  // namespace stage_spots

/// A floor lies a little below the cloud, balls and cube stand on it before the cloud (as seen along skyAxes'
/// forward), their sizes shares of half the cloud's longest side. An empty volume counts as a cloud of half
/// side 1. `from`: the place in the world that the answer is relative to.
inline StagePlaces placesOf(const Stage& stage, const glm::dvec3& up, const BrickVolume& bricks,
                            const glm::dvec3& from = glm::dvec3(0.0)) {
  StagePlaces places;
  places.axes = skyAxes(up, 0.0);
  const glm::dmat3 axes(places.axes.right, places.axes.forward, places.axes.up);
  const stage_spots::Extent extent = stage_spots::extentOf(bricks, from, axes);
  const glm::dvec3 sides = extent.high - extent.low, middle = 0.5 * (extent.low + extent.high);
  places.size = 0.5 * std::max({sides.x, sides.y, sides.z});
  const double height = stage.height ? *stage.height - glm::dot(from, places.axes.up)
                                     : extent.low.z - stage_spots::kFloorBelow * places.size;
  places.ground = axes * glm::dvec3(middle.x, middle.y, height);
  places.floorRadius = stage_spots::kFloorRadius * places.size;
  places.checker = stage.checker.value_or(stage_spots::kChecker * places.size);
  const auto place = [&](const StageThing& thing, const stage_spots::Spot& spot, double halfPerSize) {
    const double half = thing.size ? *thing.size * halfPerSize : spot.size * places.size;
    const glm::dvec3 standing(spot.across * places.size, -spot.towards * places.size, half);
    return StagePlace{thing.center ? *thing.center - from : places.ground + axes * standing, half};
  };
  places.chrome = place(stage.chrome, stage_spots::kChromeSpot, 1.0);
  places.grey = place(stage.grey, stage_spots::kGreySpot, 1.0);
  places.cube = place(stage.cube, stage_spots::kCubeSpot, 0.5);
  return places;
}

}  // namespace nephele
