// Lights and environments by name: noon, sunset, backlit, moonlight, overcast. Depends on scene alone.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace nephele {

/// One row of the table. Radiances are scene-referred so that a cloud of albedo 1 is well exposed at 0 EV.
struct Preset {
  std::string_view name;
  std::string_view sentence;
  Sun sun;  // for Z up, and a camera that looks along +Y
  SkyRamp sky;
};

/// All of them, in the order in which they are listed.
std::span<const Preset> presets();

/// Throws InputError for an unknown name ("did you mean").
const Preset& findPreset(const std::string& name);

/// Replaces the scene's lights by the preset's sun and its environment by the preset's sky; `show` and all
/// else stay. Directions are turned where the file's up is Y (Scene::lightsFollowUp, resolveScene).
void applyPreset(const Preset& preset, Scene& scene);

/// What a file opens in where no scene is given: the `report` look under the first preset.
Scene defaultScene();

}  // namespace nephele
