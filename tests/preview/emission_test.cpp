// Emission's shared text: the table against Planck's law, a glowing slab's closed form, temperatures on a
// grid of their own.
#include <gtest/gtest.h>

#include <cmath>

#include "preview/gpu/camera_rays.h"
#include "preview/gpu/light_parameters.h"
#include "preview/twin/march_picture.h"
#include "scene/blackbody.h"

namespace nephele {
namespace {

using shared::MarchParameters;

BrickVolume constantBricks(float value, const glm::ivec3& size, const glm::ivec3& origin,
                           const glm::dmat4& place) {
  const auto count = static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z);
  return bricksFromDense(std::vector<float>(count, value), size, origin, place);
}

/// A cube of 16³ voxels of side 0.25 and density 2, hot or not.
BrickVolume cube(float temperature) {
  glm::dmat4 place(0.25);
  place[3] = glm::dvec4(3.0, -2.0, 1.0, 1.0);
  BrickVolume bricks = constantBricks(2.0f, glm::ivec3(16), {-3, 9, 40}, place);
  // Coarser voxels, elsewhere in their index, around the whole cube.
  glm::dmat4 hotPlace(0.5);
  hotPlace[3] = glm::dvec4(-7.0, -9.0, 2.5, 1.0);
  const glm::ivec3 first(glm::floor(glm::dvec3(glm::inverse(hotPlace) * place * glm::dvec4(-6, 6, 37, 1))));
  bricks.temperature =
      std::make_shared<const BrickVolume>(constantBricks(temperature, glm::ivec3(14), first, hotPlace));
  return bricks;
}

ViewedScene viewOf(const BrickVolume& bricks) {
  ViewedScene view;
  view.scene.lights.clear();
  view.medium = {{0.3, 0.3, 0.3}, {0.2, 0.4, 0.6}, 0.0};
  view.camera.target = glm::dvec3(bricks.worldFromIndex * glm::dvec4(4.5, 16.5, 47.5, 1.0));
  view.camera.position = view.camera.target + glm::dvec3(0.0, -30.0, 0.0);
  view.camera.fov = 0.01;
  return view;
}

TEST(SharedEmission, TableIsPlancksLaw) {
  const BrickVolume bricks = cube(1.0f);
  struct Source : shared::NoCache {
    glm::uvec2 word(glm::ivec3) const { return glm::uvec2(0u); }
    float density(glm::uvec2, glm::vec3, glm::ivec3) const { return 0.0f; }
  };
  shared::March<Source> march{};
  setLightParameters(march.params, viewOf(bricks), bricks, frameOf(bricks));
  for (double kelvin = 505.0; kelvin < 60000.0; kelvin *= 1.01) {
    const auto expected = blackbodyRadiance(kelvin);
    const glm::vec3 actual = march.blackbodyRadiance(static_cast<float>(kelvin));
    const double largest = std::max({expected[0], expected[1], expected[2]});
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(double{actual[c]} / largest, expected[static_cast<size_t>(c)] / largest, 1e-3) << kelvin;
  }
  EXPECT_EQ(march.blackbodyRadiance(500.0f).x, 0.0f);
  EXPECT_EQ(march.blackbodyRadiance(-3.0f).x, 0.0f);
  EXPECT_TRUE(std::isfinite(march.blackbodyRadiance(1e9f).x));
}

TEST(SharedEmission, AGlowingSlabHasItsClosedForm) {
  // ∫ e^(−σ_t ρ s) σ_a ρ B ds over the cube's way, whose faces fall off over a voxel each: columns are exact.
  const BrickVolume bricks = cube(2.6f);
  ViewedScene view = viewOf(bricks);
  view.scene.emission.temperatureScale = 1000.0;
  view.scene.emission.scale = 3.0;
  const MarchParameters p = marchParameters(view, bricks, 1, 1, 0, false);
  const TwinPixel pixel = marchPicture(bricks, p, 1, 1, glm::vec2(0.5f), 0)[0];
  const auto hot = blackbodyRadiance(2600.0);
  const double column = 2.0 * 16.0 * 0.25;
  for (int c = 0; c < 3; ++c) {
    const size_t channel = static_cast<size_t>(c);
    const double sigmaA = view.medium.sigmaA[channel], sigmaT = sigmaA + 0.3;
    const double expected = 3.0 * sigmaA / sigmaT * hot[channel] * (1.0 - std::exp(-sigmaT * column));
    EXPECT_NEAR(double{pixel.radiance[c]} / expected, 1.0, 2e-3) << c;
  }
}

TEST(SharedEmission, OffMeansOff) {
  BrickVolume bricks = cube(1800.0f);
  ViewedScene view = viewOf(bricks);
  const auto factor = [&] { return marchParameters(view, bricks, 1, 1, 0, false).emission.x; };
  EXPECT_EQ(factor(), 1.0f);
  view.scene.emission.on = false;
  EXPECT_EQ(factor(), 0.0f);
  view.scene.emission.on.reset();
  view.medium.sigmaA = {0.0, 0.0, 0.0};
  EXPECT_EQ(factor(), 0.0f) << "nothing absorbs, so nothing emits";
  view.medium.sigmaA = {1.0, 0.0, 0.0};
  bricks.temperature = nullptr;
  EXPECT_EQ(factor(), 0.0f);
}

}  // namespace
}  // namespace nephele
