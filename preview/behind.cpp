// Backdrops and skies behind finished renders. Depends on what its header names.
#include "preview/behind.h"

#include <cmath>

#include "base/error.h"
#include "preview/gpu/camera_rays.h"
#include "scene/sky.h"

namespace nephele {

Behind behindOf(const Scene& scene) {
  if (scene.environment.show) return Behind::nothing;
  if (scene.backdrop || scene.look == Look::physical) return Behind::backdrop;
  return Behind::sky;
}

void addSky(Picture& picture, const ViewedScene& view) {
  const int transmittance = picture.find("transmittance.R");  // G and B follow
  NEPHELE_CHECK_LE(0, transmittance);
  constexpr double kCentre = 0.5;
  size_t pixel = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, ++pixel) {
      const glm::dvec3 ray =
          viewDirection(view.camera, picture.width, picture.height, x + kCentre, y + kCentre);
      const glm::dvec3 sky = skyRadiance(view.scene.environment, view.environmentMap.get(), view.up, ray);
      for (int c = 0; c < 3; ++c) {
        const float seen = picture.planes[static_cast<size_t>(transmittance + c)][pixel];
        picture.planes[static_cast<size_t>(c)][pixel] += seen * static_cast<float>(sky[c]);
      }
    }
  }
}

Backdrop backdropOf(const Scene& scene, double exposureEv) {
  Backdrop backdrop;
  if (behindOf(scene) != Behind::backdrop) return backdrop;
  const BackdropColours colours = scene.backdrop.value_or(BackdropColours{});
  for (size_t c = 0; c < backdrop.top.size(); ++c) {
    backdrop.bottom[c] = static_cast<float>(colours.bottom[c] * std::exp2(-exposureEv));
    backdrop.top[c] = static_cast<float>(colours.top[c] * std::exp2(-exposureEv));
  }
  return backdrop;
}

}  // namespace nephele
