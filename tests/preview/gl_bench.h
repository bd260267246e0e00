// What the tests with a driver share: one headless context, a cloud, pictures by the GPU, double-precision
// rays. Depends on preview and volume.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "preview/gpu/brick_atlas.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/egl_context.h"
#include "preview/gpu/film.h"
#include "preview/gpu/march_pass.h"

namespace nephele::testing_gl {

inline void needContext() { static EglContext context; }

/// One sample of each pixel through its place `subPixel`.
inline FilmPicture marchOnGpu(const MarchPass& pass, const BrickVolume& bricks, int width, int height,
                              glm::vec2 subPixel, unsigned number) {
  const BrickAtlas atlas(bricks, pass.filter());
  const Film film(width, height);
  pass.draw(atlas, film, subPixel, number, {0, 0, width, height});
  return film.read();
}

/// A dense box of `size` samples by a formula of the index position.
inline BrickVolume volumeOf(const glm::ivec3& size, const glm::ivec3& origin,
                            const glm::dmat4& worldFromIndex,
                            const std::function<double(const glm::dvec3&)>& density) {
  std::vector<float> values;
  values.reserve(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z));
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        values.push_back(static_cast<float>(density(glm::dvec3(origin + glm::ivec3(x, y, z)))));
  return bricksFromDense(values, size, origin, worldFromIndex);
}

/// Waves cut off at 0 inside a ball about `centre`: bumpy, with holes.
inline double cloudDensity(const glm::dvec3& p, const glm::dvec3& centre, double radius) {
  const double ball = 1.0 - glm::length(p - centre) / radius;
  const double waves = std::sin(0.31 * p.x + 1.1) * std::sin(0.27 * p.y + 0.4) * std::sin(0.35 * p.z + 2.0) +
                       0.5 * std::sin(0.83 * p.x + 0.61 * p.y) * std::sin(0.77 * p.z - 0.53 * p.y);
  return ball <= 0.0 ? 0.0 : std::max(0.0, ball + 0.6 * waves);
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
