// What undo covers: everything that makes the light, and how bright it is shown. Depends on scene and
// particles.
#pragma once

#include <memory>
#include <optional>

#include "particles/particles.h"
#include "scene/environment_map.h"
#include "scene/scene.h"

namespace nephele {

/// A camera that a change of settings took elsewhere.
struct CameraMove {
  Camera from, to;
};

/// The medium is the one in use, wherever it came from; camera and medium inside `scene` are not looked at.
struct Settings {
  Scene scene;
  Medium medium;
  std::shared_ptr<const EnvironmentMap> environmentMap;  // the picture of scene.environment.exr.path, if read
  double exposureEv = 0.0;
  std::optional<ParticleSystem> particles;  // of the file's metadata, as changed since
  std::optional<CameraMove> cameraMove;     // by the step of undo that made these settings
};

}  // namespace nephele
