// From metadata to a particle system, and from that to a recipe. Depends on preview/app/live_recipe.h and
// base.
#include "preview/app/live_recipe.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/files.h"

namespace nephele {
namespace {

namespace fs = std::filesystem;

const std::string* find(const BrickVolume& volume, const char* key) {
  const auto found = volume.metadata.find(key);
  return found == volume.metadata.end() ? nullptr : &found->second;
}

/// A number of the metadata, or `otherwise` where there is none.
double numberOf(const BrickVolume& volume, const char* key, double otherwise) {
  const std::string* text = find(volume, key);
  double value = otherwise;
  if (text == nullptr) return value;
  const auto end = std::from_chars(text->data(), text->data() + text->size(), value);
  if (end.ec != std::errc() || !std::isfinite(value))
    throw InputError({volume.path}, std::string("has metadata '") + key + "' that is no number: " + *text);
  return value;
}

/// NAME of NAME_0001.vdb and of NAME.vdb.
std::string assetNameOf(const std::string& path, bool framed) {
  std::string stem = fs::path(path).stem().string();
  const size_t cut = stem.find_last_not_of("0123456789");
  if (framed && cut != std::string::npos && stem[cut] == '_') stem.resize(cut);
  return stem;
}

std::string shortest(double value) {
  char text[32];  // the longest double takes 24 characters
  const auto end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

/// Each line of `text` behind `spaces` spaces.
std::string indented(const std::string& text, size_t spaces) {
  std::istringstream lines(text);
  std::string line, out;
  while (std::getline(lines, line)) out += line.empty() ? "\n" : std::string(spaces, ' ') + line + "\n";
  return out;
}

}  // namespace

std::optional<LiveSource> liveSourceOf(const BrickVolume& volume) {
  const std::string* block = find(volume, "particles");
  if (block == nullptr) return std::nullopt;
  LiveSource source;
  Diagnostics complaints;
  const yaml::NodePtr node = yaml::parse(*block, volume.path + " (metadata particles)");
  source.system = readParticles(*node, complaints);
  complaints.throwIfAny();
  source.settings.fps = numberOf(volume, "fps", source.settings.fps);
  if (!(source.settings.fps > 0.0)) throw InputError({volume.path}, "has metadata 'fps' that is not above 0");
  source.settings.upAxis = volume.upAxis == 'y' ? 1 : 2;
  source.settings.seed = static_cast<uint32_t>(static_cast<int64_t>(numberOf(volume, "seed", 0.0)));
  source.cutoff = numberOf(volume, "cutoff", source.cutoff);
  source.densityStep = numberOf(volume, "density_step", source.densityStep);
  if (const std::string* half = find(volume, "is_saved_as_half_float"))
    source.half = *half == "true" || *half == "1";
  source.voxelSize = glm::length(glm::dvec3(volume.worldFromIndex[0]));
  source.framed = find(volume, "frame") != nullptr;
  source.name = assetNameOf(volume.path, source.framed);
  return source;
}

std::string recipeOf(const LiveSource& source, const ParticleSystem& system, const std::string& name,
                     const std::optional<FrameRange>& frames, const std::string& scene) {
  std::string text = "# Written by nephele-preview from live particles: nephele-bake " + name + ".yaml\n";
  text += std::string("up_axis: ") + (source.settings.upAxis == 1 ? "y" : "z") + "\n";
  text += "seed: " + std::to_string(source.settings.seed) + "\n\nassets:\n  " + name + ":\n";
  text += "    voxel_size: " + shortest(source.voxelSize) + "\n";
  if (frames)
    text += "    frames: " + std::to_string(frames->begin) + "-" + std::to_string(frames->end - 1) + "\n";
  text += "    fps: " + shortest(source.settings.fps) + "\n    cutoff: " + shortest(source.cutoff) + "\n";
  if (source.densityStep > 0.0) text += "    density_step: " + shortest(source.densityStep) + "\n";
  text += std::string("    precision: ") + (source.half ? "half" : "float") + "\n    particles:\n";
  constexpr size_t kUnderParticles = 6;
  text += indented(writeParticles(system), kUnderParticles);
  if (!scene.empty()) text += "\nscene:\n" + indented(scene, 2);
  return text;
}

std::string writeLiveRecipe(const std::string& folder, const LiveSource& source, const ParticleSystem& system,
                            const std::optional<FrameRange>& frames, const std::string& scene) {
  std::string name = source.name + "_live";
  const auto pathOf = [&] { return (fs::path(folder) / (name + ".yaml")).string(); };
  for (char letter = 'b'; fs::exists(pathOf()); ++letter) {
    if (letter > 'z')
      throw WorldError("'" + folder + "' holds recipes " + source.name + "_live to _live_z already");
    name = source.name + "_live_" + letter;
  }
  const std::string path = pathOf(), text = recipeOf(source, system, name, frames, scene);
  writeText(path, text);
  return path;
}

}  // namespace nephele
