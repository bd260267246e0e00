// The stage's rows of the march's parameters. Depends on what its header names.
#include "preview/gpu/stage_parameters.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "preview/stage_places.h"

namespace nephele {
namespace {

using glm::dvec3;
using glm::vec4;

vec4 row(const dvec3& v, double w) { return vec4(glm::vec3(v), static_cast<float>(w)); }

}  // namespace

void setStage(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
              const IndexFrame& frame) {
  const Stage& stage = view.scene.stage;
  if (!stage.on) return;
  // Relative to the corner of the brick grid that is marched, in voxels of the finest level.
  const dvec3 corner = std::ldexp(1.0, frame.level) * dvec3(frame.brickMin * kBrickCells);
  const StagePlaces places =
      placesOf(stage, view.up, bricks, dvec3(bricks.worldFromIndex * glm::dvec4(corner, 1.0)));
  const double floorRadius = stage.floor ? places.floorRadius : 0.0;
  double bound = floorRadius;
  const auto place = [&](const StageThing& thing, const StagePlace& at) {
    if (!thing.on) return vec4(0.0f);
    constexpr double kCorner = 1.7320508075688772;  // of a cube, in half edges
    bound = std::max(bound, glm::distance(at.centre, places.ground) + kCorner * at.half);
    return row(at.centre, at.half);
  };
  p.stageChrome = place(stage.chrome, places.chrome);
  p.stageGrey = place(stage.grey, places.grey);
  p.stageCube = place(stage.cube, places.cube);
  p.stageFloor = row(places.ground, floorRadius);
  p.stageUp = row(places.axes.up, places.checker);
  p.stageAcross = row(places.axes.right, 0.0);
  constexpr double kRoom = 1.05;  // the floor has a thickness
  p.stage = row(dvec3(kRoom * bound, stage.penumbra, stage.highlights ? 1.0 : 0.0), places.size);
}

}  // namespace nephele
