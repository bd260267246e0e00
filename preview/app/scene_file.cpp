// Saving scenes. Depends on scene and base.
#include "preview/app/scene_file.h"

#include <filesystem>

#include "base/files.h"

namespace nephele {
namespace {

/// A recipe has its scene under a key of its own, and would be lost.
void refuseRecipe(const std::string& path) {
  if (!std::filesystem::exists(path)) return;
  const yaml::NodePtr there = yaml::load(path);
  for (const yaml::Entry& entry : there->entries)
    if (entry.key == "scene" || entry.key == "assets")
      throw InputError({path}, "holds a recipe, which a scene would overwrite", "save under another name");
}

}  // namespace

void saveScene(const std::string& path, const Settings& settings, const Camera& camera, bool fitted) {
  refuseRecipe(path);
  Scene scene = settings.scene;
  scene.camera = camera;
  scene.cameraUpGiven = true;
  scene.medium = settings.medium;
  scene.octaves.factorsGiven |= !fitted;
  writeText(path, writeScene(scene));
}

std::string sceneFileFor(const std::string& folder, const std::string& volume) {
  const std::string name = std::filesystem::path(volume).stem().string() + ".scene.yaml";
  return (std::filesystem::path(folder) / name).string();
}

}  // namespace nephele
