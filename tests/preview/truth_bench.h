// What the path tracer's tests share: scenes and one-pixel pictures. Depends on preview/truth and
// tests/preview/clouds.h.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/truth/reference_method.h"
#include "tests/preview/clouds.h"

namespace nephele::testing_truth {

using testing_clouds::cloudDensity;
using testing_clouds::volumeOf;

inline Medium mediumOf(double sigmaS, double sigmaA, double g) {
  return {{sigmaS, sigmaS, sigmaS}, {sigmaA, sigmaA, sigmaA}, g};
}

inline Sun sunFrom(const glm::dvec3& toLight, double irradiance) {
  return {glm::normalize(toLight), {irradiance, irradiance, irradiance}};
}

/// No light at all, seen from `position` towards `target`.
inline ViewedScene viewFrom(const glm::dvec3& position, const glm::dvec3& target, double fov,
                            const Medium& medium) {
  ViewedScene view;
  view.scene.lights.clear();
  view.camera.position = position;
  view.camera.target = target;
  view.camera.up =
      std::abs(glm::normalize(target - position).z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  view.camera.fov = fov;
  view.medium = medium;
  return view;
}

inline PictureRequest requestOf(int size, unsigned samples, std::optional<int> bounces = {}) {
  PictureRequest request;
  request.width = request.height = size;
  request.samples = samples;
  request.bounces = bounces;
  request.quiet = true;
  return request;
}

inline Picture renderTruth(const BrickVolume& bricks, const ViewedScene& view,
                           const PictureRequest& request) {
  const auto method = makeReferenceMethod({});
  method->setVolume(bricks);
  PictureCost cost;
  return method->render(view, request, cost);
}

inline const std::vector<float>& plane(const Picture& picture, const std::string& name) {
  return picture.planes.at(static_cast<size_t>(picture.find(name)));
}

inline double meanOf(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += double{value};
  return sum / static_cast<double>(values.size());
}

/// A bumpy ball of radius 12 voxels with holes, of world radius 1 about the origin.
inline BrickVolume smallCloud() {
  const double voxel = 1.0 / 12.0;
  const glm::dmat4 transform(voxel, 0, 0, 0, 0, voxel, 0, 0, 0, 0, voxel, 0, 0, 0, 0, 1);
  return volumeOf({25, 25, 25}, {-12, -12, -12}, transform,
                  [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(0.0), 12.0); });
}

}  // namespace nephele::testing_truth
