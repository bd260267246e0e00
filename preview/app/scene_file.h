// Scenes between the window and YAML files. Depends on scene and base.
#pragma once

#include <string>

#include "preview/app/settings.h"

namespace nephele {

/// Writes settings and camera as a scene that --scene reads back, whole or not at all. Factors of octaves are
/// written unless they are `fitted` to the volume and not changed: those follow the sun. A file that is there
/// and holds more than a scene (a recipe) is left alone: InputError. Throws WorldError where nothing can be
/// written.
void saveScene(const std::string& path, const Settings& settings, const Camera& camera, bool fitted);

/// FOLDER/NAME.scene.yaml for a volume NAME.vdb.
std::string sceneFileFor(const std::string& folder, const std::string& volume);

}  // namespace nephele
