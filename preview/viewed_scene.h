// A scene in which nothing is left open. Depends on scene alone.
#pragma once

#include <memory>

#include "scene/environment_map.h"
#include "scene/scene.h"

namespace nephele {

/// The camera and the medium are given or were chosen (preview/resolve.h); those inside `scene` are not
/// looked at. What is on: lightModelOf(scene, medium).
struct ViewedScene {
  Scene scene;
  Camera camera;
  Medium medium;
  glm::dvec3 up{0.0, 0.0, 1.0};  // unit, world: the file's, for elevation and for height in the cloud
  std::shared_ptr<const EnvironmentMap> environmentMap;  // where scene.environment.kind is exr, else nullptr
};

}  // namespace nephele
