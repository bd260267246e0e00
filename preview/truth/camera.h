// Camera rays into the medium, in double precision until they meet it. Depends on scene, volume/bricks.h and
// GLM.
#pragma once

#include <optional>

#include "preview/truth/tracking.h"
#include "scene/scene.h"

namespace nephele::truth {

/// A camera ray from where it enters the medium's support.
struct EnteringRay {
  TrackedRay ray;       // voxels from the corner of the brick grid; reach: up to the exit
  glm::vec3 along;      // unit, world axes
  double before = 0.0;  // world units from the camera to the entry
};

/// Rays through a picture of width × height pixels. Neither a far camera nor a medium far from the origin
/// costs precision. Throws InputError for a camera without a direction.
class CameraRays {
 public:
  CameraRays(const Camera& camera, const BrickVolume& bricks, int width, int height);
  /// The ray through picture position (x, y), in pixels from the top left corner; nothing where it misses the
  /// support.
  std::optional<EnteringRay> at(double x, double y) const;
  /// The ray's direction alone, unit, world axes.
  glm::dvec3 along(double x, double y) const;
  /// A ray from any place of the world within `reach`; nothing where it misses the support.
  std::optional<EnteringRay> enter(const glm::dvec3& place, const glm::dvec3& along, double reach) const;
  /// A place of the world in voxels from the corner of the brick grid.
  glm::vec3 positionOf(const glm::dvec3& place) const { return glm::vec3(indexOf(place)); }

 private:
  std::optional<EnteringRay> enterFrom(const glm::dvec3& index, const glm::dvec3& along, double reach) const;
  glm::dvec3 indexOf(const glm::dvec3& place) const;

  glm::dvec3 worldOrigin_, brickCorner_;  // of index space in the world; of the brick grid in voxels
  glm::dvec3 origin_;                     // voxels from the corner of the brick grid
  glm::dvec3 boxMin_, boxMax_;            // the support, in the same coordinates
  glm::dvec3 corner_, dx_, dy_;           // world directions, length 1 along the camera's axis
  glm::dmat3 indexFromWorld_;
};

}  // namespace nephele::truth
