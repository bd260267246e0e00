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
  const dvec3 brickCorner(bricks.brickMin * kBrickCells);
  indexFromWorld_ = glm::inverse(dmat3(bricks.worldFromIndex));
  origin_ = indexFromWorld_ * (camera.position - dvec3(bricks.worldFromIndex[3])) - brickCorner;
  // The medium reaches one voxel beyond the active samples, but never beyond the bricks.
  boxMin_ = glm::max(dvec3(bricks.activeMin - 1) - brickCorner, dvec3(0.0));
  boxMax_ = glm::min(dvec3(bricks.activeMax) - brickCorner, dvec3(bricks.brickCount * kBrickCells));
}

glm::vec3 CameraRays::along(double x, double y) const {
  return glm::vec3(glm::normalize(corner_ + x * dx_ + y * dy_));
}

std::optional<EnteringRay> CameraRays::at(double x, double y) const {
  const dvec3 along = glm::normalize(corner_ + x * dx_ + y * dy_);
  const dvec3 direction = indexFromWorld_ * along;
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = boxMin_[axis] - origin_[axis], high = boxMax_[axis] - origin_[axis];
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
  const dvec3 entry = glm::clamp(origin_ + near * direction, boxMin_, boxMax_);
  return EnteringRay{
      {glm::vec3(entry), glm::vec3(direction), static_cast<float>(far - near)}, glm::vec3(along), near};
}

}  // namespace nephele::truth
