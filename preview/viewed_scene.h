// A scene in which nothing is left open. Depends on scene alone.
#pragma once

#include "scene/scene.h"

namespace nephele {

/// The camera and the medium are given or were chosen (preview/resolve.h); those inside `scene` are not
/// looked at.
struct ViewedScene {
  Scene scene;
  Camera camera;
  Medium medium;
};

}  // namespace nephele
