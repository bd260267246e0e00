// The table of presets. Depends on scene alone.
#include "scene/presets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "scene/degrees.h"

namespace nephele {
namespace {

/// Azimuth from +Y (away from the camera) to the right, and elevation, in degrees.
glm::dvec3 toLight(double azimuth, double elevation) {
  const double a = azimuth * kRadiansPerDegree, e = elevation * kRadiansPerDegree;
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

/// Colours by eye and by daylight's order: the sun's irradiance some ten times the sky's, the horizon white,
/// the moon's light bluish and far weaker, an overcast sky without a disc to speak of.
const std::vector<Preset>& table() {
  static const std::vector<Preset> rows{
      {"noon",
       "high sun behind the left shoulder of the cloud, deep blue sky",
       {toLight(-52.0, 44.0), {17.0, 16.0, 14.4}},
       {{0.26, 0.19, 0.13}, {0.86, 1.00, 1.15}, {0.06, 0.22, 0.68}, 0.1, 1.0}},
      {"sunset",
       "low orange sun from the left, violet above",
       {toLight(-62.0, 5.0), {17.0, 8.0, 2.6}},
       {{0.12, 0.07, 0.06}, {1.30, 0.62, 0.28}, {0.13, 0.14, 0.36}, 0.2, 1.0}},
      {"backlit",
       "sun behind the cloud: silver rims",
       {toLight(-10.0, 22.0), {17.0, 16.0, 14.4}},
       {{0.18, 0.15, 0.12}, {0.62, 0.74, 0.88}, {0.06, 0.17, 0.44}, 0.2, 1.0}},
      {"moonlight",
       "bluish moon behind the cloud, night sky",
       {toLight(-40.0, 38.0), {2.3, 2.8, 3.6}},
       {{0.005, 0.006, 0.009}, {0.045, 0.065, 0.115}, {0.006, 0.011, 0.030}, 0.1, 1.0}},
      {"overcast",
       "a white sky that hides the sun",
       {toLight(-60.0, 60.0), {4.0, 4.0, 4.0}},
       {{0.24, 0.22, 0.20}, {0.78, 0.84, 0.93}, {0.92, 1.00, 1.12}, 0.9, 1.0}}};
  return rows;
}

// Of the scene that a file opens in.
constexpr int kDefaultOctaves = 5;

}  // namespace

std::span<const Preset> presets() { return table(); }

const Preset& findPreset(const std::string& name) {
  std::vector<std::string_view> names;
  for (const Preset& row : table()) names.push_back(row.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError({}, "unknown preset '" + name + "'", didYouMean(name, names));
  return table()[static_cast<size_t>(found - names.begin())];
}

void applyPreset(const Preset& preset, Scene& scene) {
  scene.lights = {preset.sun};
  scene.environment.kind = Environment::Kind::ramp;
  scene.environment.ramp = preset.sky;
  scene.lightsFollowUp = true;
}

Scene defaultScene() {
  Scene scene;
  scene.look = Look::report;
  scene.octaves = {kDefaultOctaves, 0.45, 0.57, 0.5};  // brighter in the shade than the keys' defaults
  applyPreset(presets().front(), scene);
  return scene;
}

}  // namespace nephele
