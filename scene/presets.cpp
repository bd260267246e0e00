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
       "high sun from the left, deep blue sky",
       {toLight(-75.0, 48.0), {5.2, 4.9, 4.4}},
       {{0.26, 0.19, 0.13}, {0.62, 0.74, 0.88}, {0.09, 0.21, 0.50}, 0.1, 1.0}},
      {"sunset",
       "low orange sun from the left, violet above",
       {toLight(-68.0, 6.0), {6.0, 2.6, 0.9}},
       {{0.10, 0.06, 0.05}, {0.85, 0.42, 0.20}, {0.10, 0.12, 0.30}, 0.2, 1.0}},
      {"backlit",
       "sun behind the cloud: silver rims",
       {toLight(-14.0, 24.0), {6.0, 5.5, 4.8}},
       {{0.20, 0.15, 0.11}, {0.55, 0.64, 0.76}, {0.07, 0.16, 0.38}, 0.2, 1.0}},
      {"moonlight",
       "bluish moon behind the shoulder, night sky",
       {toLight(-40.0, 38.0), {0.42, 0.50, 0.66}},
       {{0.004, 0.004, 0.006}, {0.030, 0.040, 0.065}, {0.004, 0.007, 0.018}, 0.1, 1.0}},
      {"overcast",
       "a white sky without a shadow",
       {toLight(-60.0, 60.0), {0.5, 0.5, 0.5}},
       {{0.16, 0.14, 0.12}, {0.62, 0.64, 0.67}, {0.75, 0.78, 0.83}, 1.0, 1.0}}};
  return rows;
}

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
  applyPreset(presets().front(), scene);
  return scene;
}

}  // namespace nephele
