// Angles of the sun. Depends on app/orbit_camera.h.
#include "preview/app/sun_drag.h"

#include <algorithm>
#include <numbers>

#include "preview/app/orbit_camera.h"

namespace nephele {

glm::dvec3 dragSun(const glm::dvec3& toLight, const glm::dvec3& up, double right, double down) {
  // Short of the pole, where the azimuth would be forgotten: a drag up and back must come back.
  constexpr double kMost = 0.5 * std::numbers::pi - 1e-4;
  Angles angles = anglesOf(toLight, up);
  angles.azimuth += std::numbers::pi * right;
  if (down != 0.0) angles.elevation = std::clamp(angles.elevation - std::numbers::pi * down, -kMost, kMost);
  return directionOf(angles, up);
}

}  // namespace nephele
