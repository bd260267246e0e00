// The environment by direction. Depends on scene alone.
#include "scene/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/error.h"

namespace nephele {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 vectorOf(const Rgb& rgb) { return {rgb[0], rgb[1], rgb[2]}; }

glm::dvec3 rampRadiance(const SkyRamp& ramp, double sine) {
  const RampShape shape = rampShape(ramp.cloudiness);
  const glm::dvec3 horizon = vectorOf(ramp.horizon);
  const bool above = sine >= 0.0;
  const glm::dvec3 far = above ? vectorOf(ramp.zenith) : shape.groundFactor * vectorOf(ramp.ground);
  const double share =
      std::pow(1.0 - std::min(std::abs(sine), 1.0), above ? shape.skyPower : shape.groundPower);
  return ramp.intensity * (far + share * (horizon - far));
}

glm::dvec3 mapRadiance(const LatLong& exr, const EnvironmentMap& map, const glm::dvec3& up,
                       const glm::dvec3& direction) {
  const SkyAxes axes = skyAxes(up, exr.rotation);
  const double azimuth = std::atan2(glm::dot(direction, axes.right), glm::dot(direction, axes.forward));
  const double sine = std::clamp(glm::dot(direction, axes.up), -1.0, 1.0);
  return exr.intensity * map.radiance(0.5 + azimuth / (2.0 * kPi), std::acos(sine) / kPi);
}

}  // namespace

SkyAxes skyAxes(const glm::dvec3& up, double rotation) {
  const glm::dvec3 ahead =
      std::abs(up.y) > std::abs(up.z) ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 side = glm::normalize(glm::cross(ahead, up));
  const glm::dvec3 straight = glm::cross(up, side);
  const glm::dvec3 forward = std::cos(rotation) * straight - std::sin(rotation) * side;
  return {glm::cross(forward, up), forward, up};
}

RampShape rampShape(double cloudiness) {
  constexpr double kClearPower = 5.0, kOvercastPower = 0.5, kGroundPower = 24.0, kShade = 0.6;
  return {kClearPower + (kOvercastPower - kClearPower) * cloudiness, kGroundPower, 1.0 - kShade * cloudiness};
}

glm::dvec3 skyRadiance(const Environment& environment, const EnvironmentMap* map, const glm::dvec3& up,
                       const glm::dvec3& direction) {
  switch (environment.kind) {
    case Environment::Kind::ramp:
      return rampRadiance(environment.ramp, glm::dot(direction, up));
    case Environment::Kind::exr:
      NEPHELE_CHECK_EQ(map != nullptr, true);
      return mapRadiance(environment.exr, *map, up, direction);
    case Environment::Kind::constant:
      break;
  }
  return vectorOf(environment.constant);
}

glm::dvec3 meanSkyRadiance(const Environment& environment) {
  NEPHELE_CHECK_EQ(environment.kind == Environment::Kind::exr, false);
  if (environment.kind == Environment::Kind::constant) return vectorOf(environment.constant);
  const SkyRamp& ramp = environment.ramp;
  const RampShape shape = rampShape(ramp.cloudiness);
  // Directions are even over the sine, and (1 - |sine|)^n is 1/(n + 1) on the mean.
  const auto half = [&](const glm::dvec3& far, double power) {
    return far + (vectorOf(ramp.horizon) - far) / (power + 1.0);
  };
  return 0.5 * ramp.intensity *
         (half(vectorOf(ramp.zenith), shape.skyPower) +
          half(shape.groundFactor * vectorOf(ramp.ground), shape.groundPower));
}

}  // namespace nephele
