// Between heights of the sun. Depends on what its header names.
#include "scene/sun_factors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace nephele {

OctaveFactors factorsAt(const SunFactors& factors, double elevation) {
  constexpr auto& nodes = kFittedElevations;
  const double height = std::clamp(std::abs(elevation), nodes.front(), nodes.back());
  size_t above = 1;
  while (height > nodes[above]) ++above;
  const double share = (height - nodes[above - 1]) / (nodes[above] - nodes[above - 1]);
  OctaveFactors between{};
  for (size_t i = 0; i < between.size(); ++i)
    between[i] = (1.0 - share) * factors[above - 1][i] + share * factors[above][i];
  return between;
}

double sunElevation(const Scene& scene, const glm::dvec3& up) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  double elevation = kFittedElevations[kFittedElevations.size() / 2], brightest = 0.0;
  for (const Light& light : scene.lights) {
    const Sun* sun = std::get_if<Sun>(&light);
    if (!sun) continue;
    const double brightness = sun->irradiance[0] + sun->irradiance[1] + sun->irradiance[2];
    if (brightness <= brightest) continue;
    brightest = brightness;
    elevation = kDegrees * std::asin(std::clamp(glm::dot(glm::normalize(sun->toLight), up), -1.0, 1.0));
  }
  return elevation;
}

}  // namespace nephele
