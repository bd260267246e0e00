// Thermal emission as the path tracer meets it. Depends on preview/viewed_scene.h, scene, volume/bricks.h and
// GLM.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>

#include "preview/viewed_scene.h"
#include "volume/bricks.h"

namespace nephele::truth {

/// The black body at each place of a medium. Safe to use from many threads.
class Emitter {
 public:
  /// Whether what absorbs in this scene glows: emission is not off, and the volume has temperatures.
  static bool isOn(const ViewedScene& view, const BrickVolume& bricks);

  /// `bricks` holds temperatures.
  Emitter(const ViewedScene& view, const BrickVolume& bricks);
  /// scale · B(T · temperature scale) at a position, in voxels from the corner of the brick grid; B within
  /// 1e-3 of blackbodyRadiance above 600 K.
  glm::vec3 radiance(const glm::vec3& position) const;

 private:
  std::shared_ptr<const BrickVolume> temperature_;
  glm::dmat4 heatFromPosition_;
  double scale_, temperatureScale_;
};

}  // namespace nephele::truth
