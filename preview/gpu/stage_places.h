// Where the stage's floor and things stand: places and sizes that a scene leaves open follow from the cloud.
// Depends on scene and volume/bricks.h.
#pragma once

#include <optional>

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

/// A floor lies a little below the cloud, balls and cube stand on it before the cloud (as seen along skyAxes'
/// forward), their sizes shares of half the cloud's longest side. An empty volume counts as a cloud of half
/// side 1. `from`: the place in the world that the answer is relative to.
StagePlaces placesOf(const Stage& stage, const glm::dvec3& up, const BrickVolume& bricks,
                     const glm::dvec3& from = glm::dvec3(0.0));

}  // namespace nephele
