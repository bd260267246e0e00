// Orbit, pan and zoom. Depends on scene alone.
#include "preview/app/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace nephele {
namespace {

using glm::dvec3;

struct Sides {
  dvec3 a, b;
};

/// Two unit vectors across `up` (unit), right-handed with it: x and y where up is z.
Sides sidesOf(const dvec3& up) {
  constexpr double kNearlyX = 0.9;
  const dvec3 helper = std::abs(up.x) < kNearlyX ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
  const dvec3 a = glm::normalize(helper - glm::dot(helper, up) * up);
  return {a, glm::cross(up, a)};
}

}  // namespace

Angles anglesOf(const dvec3& direction, const dvec3& up) {
  const dvec3 unitUp = glm::normalize(up);
  const Sides sides = sidesOf(unitUp);
  const dvec3 unit = glm::normalize(direction);
  return {std::atan2(glm::dot(unit, sides.b), glm::dot(unit, sides.a)),
          std::asin(std::clamp(glm::dot(unit, unitUp), -1.0, 1.0))};
}

dvec3 directionOf(const Angles& angles, const dvec3& up) {
  const dvec3 unitUp = glm::normalize(up);
  const Sides sides = sidesOf(unitUp);
  return std::cos(angles.elevation) *
             (std::cos(angles.azimuth) * sides.a + std::sin(angles.azimuth) * sides.b) +
         std::sin(angles.elevation) * unitUp;
}

dvec3 rayThrough(const Camera& camera, double x, double y, double aspect) {
  const dvec3 forward = glm::normalize(camera.target - camera.position);
  const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const double half = std::tan(0.5 * camera.fov);
  return glm::normalize(forward + half * (2.0 * x - 1.0) * aspect * right +
                        half * (1.0 - 2.0 * y) * glm::cross(right, forward));
}

OrbitCamera::OrbitCamera(const Camera& camera)
    : target_(camera.target), up_(glm::normalize(camera.up)), fov_(camera.fov) {
  const Sides sides = sidesOf(up_);
  sideA_ = sides.a;
  sideB_ = sides.b;
  const dvec3 offset = camera.position - camera.target;
  distance_ = glm::length(offset);
  const Angles angles = anglesOf(offset, up_);
  azimuth_ = angles.azimuth;
  elevation_ = std::clamp(angles.elevation, -kMostElevation, kMostElevation);
}

void OrbitCamera::orbit(double azimuth, double elevation) {
  azimuth_ += azimuth;
  elevation_ = std::clamp(elevation_ + elevation, -kMostElevation, kMostElevation);
}

void OrbitCamera::pan(double right, double up) {
  const Camera now = camera();
  const dvec3 forward = glm::normalize(now.target - now.position);
  const dvec3 rightAxis = glm::normalize(glm::cross(forward, up_));
  const double height = 2.0 * distance_ * std::tan(0.5 * fov_);
  target_ -= height * (right * rightAxis + up * glm::cross(rightAxis, forward));
}

void OrbitCamera::zoom(double factor) { distance_ *= factor; }

void OrbitCamera::look(double azimuth, double elevation) {
  const dvec3 position = camera().position;
  orbit(azimuth, elevation);
  target_ += position - camera().position;
}

void OrbitCamera::fly(double forward, double right, double up) {
  const Camera now = camera();
  const dvec3 ahead = glm::normalize(now.target - now.position);
  target_ += forward * ahead + right * glm::normalize(glm::cross(ahead, up_)) + up * up_;
}

void OrbitCamera::focus(const dvec3& point) {
  const Camera now = camera();
  const dvec3 ahead = glm::normalize(now.target - now.position);
  const double depth = glm::dot(point - now.position, ahead);
  if (!(depth > 0.0)) return;
  target_ = point;
  distance_ = depth;
}

Camera OrbitCamera::camera() const {
  const dvec3 from = std::cos(elevation_) * (std::cos(azimuth_) * sideA_ + std::sin(azimuth_) * sideB_) +
                     std::sin(elevation_) * up_;
  Camera camera;
  camera.target = target_;
  camera.position = target_ + distance_ * from;
  camera.up = up_;
  camera.fov = fov_;
  return camera;
}

}  // namespace nephele
