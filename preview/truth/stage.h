// The look-dev stage as the path tracer meets it: exact intersections, hard shadows, Lambert and mirror
// surfaces. Depends on preview/stage_places.h, scene and GLM; shares no text with the march.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "preview/stage_places.h"
#include "preview/viewed_scene.h"

namespace nephele::truth {

/// A surface that a ray meets.
struct StageHit {
  double distance = 0.0;
  glm::dvec3 normal{0.0};  // unit, towards the ray's origin
  glm::dvec3 albedo{0.0};  // of Lambert's law
  double mirror = 0.0;     // share that is reflected
};

/// Safe to use from many threads. Places and directions are the world's, directions of unit length.
class StageSurfaces {
 public:
  StageSurfaces(const ViewedScene& view, const BrickVolume& bricks);
  /// The first surface along a ray. From on a surface, that surface is not met.
  std::optional<StageHit> hit(const glm::dvec3& origin, const glm::dvec3& along) const;
  /// Whether anything stands on the way of that length.
  bool blocks(const glm::dvec3& origin, const glm::dvec3& along, double reach) const;
  /// The way to the first thing from a position in the medium, in voxels from the corner of the brick grid;
  /// infinite where there is none.
  float wayFrom(const glm::vec3& position, const glm::vec3& along) const;

 private:
  StagePlaces places_;  // of size 0 where they are off
  glm::dmat3 axes_;
  glm::dmat4 worldFromPosition_;
};

}  // namespace nephele::truth
