// Scenes as YAML text. Depends on base alone.
#include <charconv>
#include <cmath>
#include <filesystem>

#include "scene/degrees.h"
#include "scene/scene.h"

namespace nephele {
namespace {

/// The shortest text that reads back to the same number.
std::string shortest(double value) {
  char text[32];  // the longest double takes 24 characters
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

std::string listOf(const std::array<double, 3>& values) {
  return std::string("[") + shortest(values[0]) + ", " + shortest(values[1]) + ", " + shortest(values[2]) +
         "]";
}

std::string listOf(const glm::dvec3& v) { return listOf(std::array{v.x, v.y, v.z}); }

/// Degrees that readCamera turns into `radians` to the last bit, where such exist; else the nearest.
double degreesOf(double radians) {
  double nearest = radians / kRadiansPerDegree;
  const double low = std::nextafter(nearest, 0.0), high = std::nextafter(nearest, 2.0 * nearest);
  for (const double candidate : {low, high})
    if (candidate * kRadiansPerDegree == radians) nearest = candidate;
  // Of all degrees that give these bits, the one that a person would have typed.
  constexpr double kTypedDigits = 1e10;
  const double typed = std::round(nearest * kTypedDigits) / kTypedDigits;
  return typed * kRadiansPerDegree == radians ? typed : nearest;
}

std::string textOf(const Light& light) {
  if (const Sun* sun = std::get_if<Sun>(&light))
    return "  - sun: { to_light: " + listOf(sun->toLight) + ", irradiance: " + listOf(sun->irradiance) +
           " }\n";
  const PointLight& point = std::get<PointLight>(light);
  return "  - point: { position: " + listOf(point.position) + ", intensity: " + listOf(point.intensity) +
         " }\n";
}

std::string textOf(const std::vector<Light>& lights) {
  if (lights.empty()) return "lights: []\n";
  std::string text =
      "# Sun: irradiance on a plane that faces it, to_light from the cloud to it. Point: intensity per "
      "steradian.\n"
      "lights:\n";
  for (const Light& light : lights) text += textOf(light);
  return text;
}

std::string textOf(const Camera& camera, bool upGiven) {
  return "# Lengths in world units; fov: full vertical angle in degrees.\ncamera: { position: " +
         listOf(camera.position) + ", target: " + listOf(camera.target) +
         (upGiven ? ", up: " + listOf(camera.up) : std::string()) +
         ", fov: " + shortest(degreesOf(camera.fov)) + " }\n";
}

std::string textOf(const Switch& on) { return !on ? "auto" : *on ? "true" : "false"; }

/// `text` as YAML reads it back: between double quotes, with what they would end or change escaped.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// Nothing where a file's fitted factors may stand in for them: those follow the sun.
std::string factorsOf(const Octaves& octaves) {
  if (!octaves.factorsGiven) return {};
  return ", a: " + shortest(octaves.a) + ", b: " + shortest(octaves.b) + ", c: " + shortest(octaves.c) +
         ", d: " + shortest(octaves.d);
}

std::string termsOf(const Scene& scene) {
  const SilverLining& silver = scene.silverLining;
  const Emission& emission = scene.emission;
  return "# Terms: on is true, false, or auto, which leaves it to the look. Lobes in [0, 1).\n"
         "phase: { silver_lining: { on: " +
         textOf(silver.on) + ", in_s: " + shortest(silver.inS) + ", out_s: " + shortest(silver.outS) +
         ", blend: " + shortest(silver.blend) + " } }\npowder: { on: " + textOf(scene.powder.on) +
         ", o_sa: " + shortest(scene.powder.oSa) +
         " }\nlight_transmittance: " + nameOf(scene.lightTransmittance) +
         "\n# Orders of scattering beyond the first. Order m sees a^m of the extinction towards the light "
         "and c^m of g, "
         "and weighs\n# (b (1 - d openness))^m: openness is the share of light that leaves the cloud "
         "unscattered.\noctaves: { count: " +
         (scene.octaves.count ? std::to_string(*scene.octaves.count) : "auto") + factorsOf(scene.octaves) +
         " }\n# temperature_scale: kelvin per unit of the grid.\nemission: { on: " + textOf(emission.on) +
         ", scale: " + shortest(emission.scale) +
         ", temperature_scale: " + shortest(emission.temperatureScale) + ", grid: " + quoted(emission.grid) +
         " }\n";
}

std::string textOf(const SkyRamp& ramp) {
  return "ramp: { ground: " + listOf(ramp.ground) + ", horizon: " + listOf(ramp.horizon) +
         ", zenith: " + listOf(ramp.zenith) + ", cloudiness: " + shortest(ramp.cloudiness) +
         ", intensity: " + shortest(ramp.intensity) + " }";
}

std::string textOf(const LatLong& exr, const std::string& folder) {
  const std::filesystem::path path(exr.path);
  const std::string shown = folder.empty() ? exr.path : std::filesystem::proximate(path, folder).string();
  return "exr: { path: " + quoted(shown) + ", rotation: " + shortest(degreesOf(exr.rotation)) +
         ", intensity: " + shortest(exr.intensity) + " }";
}

std::string textOf(const StageThing& thing, const char* size) {
  return std::string("{ on: ") + (thing.on ? "true" : "false") +
         ", center: " + (thing.center ? listOf(*thing.center) : "auto") + ", " + size + ": " +
         (thing.size ? shortest(*thing.size) : "auto") + " }";
}

std::string textOf(const Stage& stage) {
  const auto open = [](const std::optional<double>& value) { return value ? shortest(*value) : "auto"; };
  return std::string(
             "# Solid things around the cloud. penumbra: sharpness of their shadows, 0 for hard ones.\n"
             "stage:\n  on: ") +
         (stage.on ? "true" : "false") + "\n  floor: " + (stage.floor ? "true" : "false") +
         "\n  height: " + open(stage.height) + "\n  checker: " + open(stage.checker) +
         "\n  chrome_ball: " + textOf(stage.chrome, "radius") +
         "\n  grey_ball: " + textOf(stage.grey, "radius") + "\n  chrome_cube: " + textOf(stage.cube, "edge") +
         "\n  highlights: " + (stage.highlights ? "true" : "false") +
         "\n  penumbra: " + shortest(stage.penumbra) + "\n";
}

std::string textOf(const Environment& environment, const std::string& folder) {
  std::string text =
      "# Radiance from all around: constant, ramp or exr; rotation in degrees.\nenvironment: { ";
  switch (environment.kind) {
    case Environment::Kind::constant:
      text += "constant: " + listOf(environment.constant);
      break;
    case Environment::Kind::ramp:
      text += textOf(environment.ramp);
      break;
    case Environment::Kind::exr:
      text += textOf(environment.exr, folder);
      break;
  }
  return text + ", show: " + (environment.show ? "true" : "false") + " }\n";
}

}  // namespace

std::string writeScene(const Scene& scene, const std::string& folder) {
  std::string text;
  if (scene.camera) text += textOf(*scene.camera, scene.cameraUpGiven);
  if (scene.medium)
    text += "# Per unit density per world unit; g: Henyey-Greenstein asymmetry.\nmedium: { sigma_s: " +
            listOf(scene.medium->sigmaS) + ", sigma_a: " + listOf(scene.medium->sigmaA) +
            ", g: " + shortest(scene.medium->g) + " }\n";
  text += termsOf(scene);
  text += textOf(scene.lights);
  text += textOf(scene.environment, folder);
  if (scene.backdrop)
    text += "# Behind window and PNG only, linear Rec.709: no light.\nbackground: { bottom: " +
            listOf(scene.backdrop->bottom) + ", top: " + listOf(scene.backdrop->top) + " }\n";
  if (scene.stage != Stage{}) text += textOf(scene.stage);
  text += "look: " + nameOf(scene.look) + "\n";
  text +=
      "# Steps in voxels, in the view taken to cover step_pixels at least where that takes little of it; "
      "each towards a light is shadow_growth times the one before."
      "\n# adaptive: longer where the medium is thin. light_cache: light from samples `cache` and "
      "`sky_cache` voxels apart,"
      "\n# after cache_near voxels marched in so many steps, where a voxel of mean density is at most "
      "cache_depth thick."
      "\n# level_pixels: voxels that cover at most so many come from coarser levels.\nmarch: { step: " +
      shortest(scene.march.stepVoxels) + ", shadow_step: " + shortest(scene.march.shadowStepVoxels) +
      ", shadow_growth: " + shortest(scene.march.shadowGrowth) +
      ", adaptive: " + (scene.march.adaptive ? "true" : "false") +
      ", light_cache: " + (scene.march.lightCache ? "true" : "false") +
      ", cache: " + shortest(scene.march.cacheVoxels) +
      ", sky_cache: " + shortest(scene.march.skyCacheVoxels) +
      ", cache_near: " + shortest(scene.march.cacheNearVoxels) +
      ", cache_depth: " + shortest(scene.march.cacheDepth) +
      ", cache_near_steps: " + std::to_string(scene.march.cacheNearSteps) +
      ", give_up: " + shortest(scene.march.giveUp) +
      ", check_skips: " + (scene.march.checkSkips ? "true" : "false") +
      ", precision: " + nameOf(scene.march.precision) +
      ", level_pixels: " + shortest(scene.march.levelPixels) +
      ", step_pixels: " + shortest(scene.march.stepPixels) + " }\n";
  return text;
}

}  // namespace nephele
