// Camera rays. Depends on scene, volume/bricks.h and GLM.
#include "preview/truth/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"

namespace nephele::truth {

using glm::dmat3;
using glm::dvec3;

CameraRays::CameraRays(const Camera& camera, const BrickVolume& bricks, int width, int height) {
  const dvec3 view = camera.target - camera.position;
  if (!(glm::length(view) > 0.0))
    throw InputError({}, "the camera's target is its position, so it looks nowhere");
  const dvec3 forward = glm::normalize(view);
  const dvec3 side = glm::cross(forward, camera.up);
  constexpr double kParallel = 1e-9;  // sine of the angle between view and up
  if (!(glm::length(side) > kParallel * glm::length(camera.up)))
    throw InputError({}, "the camera's up points along its view");
  const dvec3 right = glm::normalize(side), up = glm::cross(right, forward);
  const double half = std::tan(0.5 * camera.fov), pixel = 2.0 * half / height;
  corner_ = forward - 0.5 * pixel * width * right + half * up;
  dx_ = pixel * right;
  dy_ = -pixel * up;
  brickCorner_ = dvec3(bricks.brickMin * kBrickCells);
  worldOrigin_ = dvec3(bricks.worldFromIndex[3]);
  indexFromWorld_ = glm::inverse(dmat3(bricks.worldFromIndex));
  origin_ = indexOf(camera.position);
  // The medium reaches one voxel beyond the active samples, but never beyond the bricks.
  boxMin_ = glm::max(dvec3(bricks.activeMin - 1) - brickCorner_, dvec3(0.0));
  boxMax_ = glm::min(dvec3(bricks.activeMax) - brickCorner_, dvec3(bricks.brickCount * kBrickCells));
}

dvec3 CameraRays::along(double x, double y) const { return glm::normalize(corner_ + x * dx_ + y * dy_); }

dvec3 CameraRays::indexOf(const dvec3& place) const {
  return indexFromWorld_ * (place - worldOrigin_) - brickCorner_;
}

std::optional<EnteringRay> CameraRays::at(double x, double y) const {
  return enterFrom(origin_, along(x, y), std::numeric_limits<double>::infinity());
}

std::optional<EnteringRay> CameraRays::enter(const dvec3& place, const dvec3& along, double reach) const {
  return enterFrom(indexOf(place), along, reach);
}

std::optional<EnteringRay> CameraRays::enterFrom(const dvec3& index, const dvec3& along, double reach) const {
  const dvec3 direction = indexFromWorld_ * along;
  double near = 0.0, far = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = boxMin_[axis] - index[axis], high = boxMax_[axis] - index[axis];
    constexpr double kStill = 1e-200;  // quotients of slower components overflow
    if (std::abs(direction[axis]) < kStill) {
      if (low > 0.0 || high < 0.0) return {};
      continue;
    }
    const double a = low / direction[axis], b = high / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  if (!(near < far)) return {};
  const dvec3 entry = glm::clamp(index + near * direction, boxMin_, boxMax_);
  return EnteringRay{
      {glm::vec3(entry), glm::vec3(direction), static_cast<float>(far - near)}, glm::vec3(along), near};
}

}  // namespace nephele::truth
