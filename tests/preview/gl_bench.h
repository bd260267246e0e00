// What the tests with a driver share: one headless context, a cloud, pictures by the GPU, double-precision
// rays. Depends on preview and volume.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "preview/gpu/brick_atlas.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/egl_context.h"
#include "preview/gpu/film.h"
#include "preview/gpu/march_pass.h"
#include "tests/preview/clouds.h"

namespace nephele::testing_gl {

using testing_clouds::cloudDensity;
using testing_clouds::volumeOf;

inline void needContext() {
  static EglContext context;
  NEPHELE_CHECK_EQ(context.makeCurrent(), true);
}

/// One sample of each pixel through its place `subPixel`.
inline FilmPicture marchOnGpu(MarchPass& pass, const BrickVolume& bricks, int width, int height,
                              glm::vec2 subPixel, unsigned number, Texel texel = Texel::r32f) {
  const BrickAtlas atlas(bricks, pass.filter(), texel);
  const Film film(width, height);
  pass.draw(atlas, film, subPixel, number, {0, 0, width, height});
  return film.read();
}

/// Transmittance of a picture that holds no light, in steps of a tenth of a voxel; rows from the top.
inline std::vector<float> transmittanceOnGpu(const BrickVolume& bricks, const Camera& camera, double sigmaT,
                                             int width, int height) {
  ViewedScene view;
  view.camera = camera;
  view.scene.lights.clear();
  view.scene.march.stepVoxels = 0.1;
  view.scene.march.stepPixels = 0.0;
  view.scene.march.adaptive = false;
  view.medium.sigmaS = {sigmaT, sigmaT, sigmaT};
  MarchPass pass(Filter::exact);
  pass.setParameters(marchParameters(view, bricks, width, height, 0, false));
  Picture picture = marchOnGpu(pass, bricks, width, height, {0.5f, 0.5f}, 0).picture;
  return std::move(picture.planes[static_cast<size_t>(picture.find("transmittance.G"))]);
}

struct WorldRay {
  glm::dvec3 origin, direction;  // unit
};

/// The ray through a picture position, straight from the camera's definition.
inline WorldRay cameraRay(const Camera& camera, int width, int height, double x, double y) {
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(0.5 * camera.fov);
  const double across = (2.0 * x - width) / height * half, above = (1.0 - 2.0 * y / height) * half;
  return {camera.position, glm::normalize(forward + across * right + above * up)};
}

/// ∫ ρ ds along the ray from its origin on, in world units, of the trilinear grid: cell by cell, where the
/// density is a cubic along the ray, so that Gauss of order 2 is exact.
double exactColumn(const BrickVolume& bricks, const WorldRay& ray);

}  // namespace nephele::testing_gl
