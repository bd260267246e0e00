// Sampling of lights. Depends on scene and GLM.
#include "preview/truth/light_sources.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/error.h"

namespace nephele::truth {
namespace {

using glm::vec3;

vec3 vectorOf(const Rgb& rgb) { return vec3(glm::dvec3(rgb[0], rgb[1], rgb[2])); }

constexpr float kUniformDensity = 0.25f / std::numbers::pi_v<float>;
constexpr float kFullTurn = 2.0f * std::numbers::pi_v<float>;

/// The ramp as a picture, for drawing directions alone: their density need not follow the radiance exactly.
std::shared_ptr<const EnvironmentMap> tableOfRamp(const ViewedScene& view) {
  constexpr int kRows = 2 * kEnvironmentCellsUp;
  std::vector<vec3> texels;
  const SkyAxes axes = skyAxes(view.up, 0.0);
  for (int row = 0; row < kRows; ++row) {
    const double elevation = (0.5 - (row + 0.5) / kRows) * std::numbers::pi;
    const glm::dvec3 direction = std::cos(elevation) * axes.forward + std::sin(elevation) * axes.up;
    texels.emplace_back(skyRadiance(view.scene.environment, nullptr, view.up, direction));
  }
  return std::make_shared<const EnvironmentMap>(makeEnvironmentMap("ramp", 1, kRows, std::move(texels)));
}

bool anyLight(const EnvironmentMap& map) {
  return std::any_of(map.texels.begin(), map.texels.end(),
                     [](const vec3& texel) { return texel != vec3(0.0f); });
}

}  // namespace

LightSources::LightSources(const ViewedScene& view, const TrackedMedium& medium,
                           const glm::dvec3& worldCorner)
    : worldFromIndex_(medium.worldFromIndex), view_(view), axes_(skyAxes(view.up, 0.0)) {
  const glm::dmat3 indexFromWorld = glm::inverse(glm::dmat3(medium.bricks->worldFromIndex));
  for (const Light& light : view.scene.lights) {
    if (const Sun* sun = std::get_if<Sun>(&light)) {
      lights_.push_back({true, vec3(glm::normalize(sun->toLight)), vectorOf(sun->irradiance)});
    } else {
      const PointLight& point = std::get<PointLight>(light);
      lights_.push_back(
          {false, vec3(indexFromWorld * (point.position - worldCorner)), vectorOf(point.intensity)});
    }
  }
  const Environment& environment = view.scene.environment;
  if (environment.kind == Environment::Kind::ramp) {
    table_ = tableOfRamp(view);
  } else if (environment.kind == Environment::Kind::exr) {
    NEPHELE_CHECK_EQ(view.environmentMap != nullptr, true);
    table_ = view.environmentMap;
    axes_ = skyAxes(view.up, environment.exr.rotation);
  }
  hasSky_ = table_ ? anyLight(*table_) : environment.constant != Rgb{};
}

LitFrom LightSources::at(size_t i, const vec3& position) const {
  const Source& light = lights_[i];
  if (light.isSun) return {light.place, std::numeric_limits<float>::infinity(), light.power};
  const vec3 apart = worldFromIndex_ * (light.place - position);
  const float distance = glm::length(apart);
  if (!(distance > 0.0f)) return {};
  const vec3 toLight = apart / distance;
  return {toLight, distance, light.power / distance / distance};
}

vec3 LightSources::sky(const vec3& toSky) const {
  return vec3(skyRadiance(view_.scene.environment, view_.environmentMap.get(), view_.up, glm::dvec3(toSky)));
}

SkyDirection LightSources::sampleSky(float u1, float u2, Random& random) const {
  float height = u1, around = u2, density = kUniformDensity;  // both in [0, 1): even in solid angle
  if (table_) {
    const auto cellOf = [](float u, int count) {
      return std::min(static_cast<int>(u * static_cast<float>(count)), count - 1);
    };
    int cell =
        cellOf(u1, kEnvironmentCellsUp) * kEnvironmentCellsAround + cellOf(u2, kEnvironmentCellsAround);
    const glm::vec4& entry = table_->cells[static_cast<size_t>(cell)];
    if (random.uniform() >= entry.x) cell = static_cast<int>(entry.y);
    density = table_->cells[static_cast<size_t>(cell)].z;
    const float row = static_cast<float>(cell / kEnvironmentCellsAround) + random.uniform();
    const float column = static_cast<float>(cell % kEnvironmentCellsAround) + random.uniform();
    height = row / static_cast<float>(kEnvironmentCellsUp);
    around = column / static_cast<float>(kEnvironmentCellsAround);
  }
  const float sine = 1.0f - 2.0f * height, cosine = std::sqrt(std::max(0.0f, 1.0f - sine * sine));
  const float azimuth = kFullTurn * (around - 0.5f);
  const vec3 flat = std::sin(azimuth) * vec3(axes_.right) + std::cos(azimuth) * vec3(axes_.forward);
  return {glm::normalize(cosine * flat + sine * vec3(axes_.up)), density};
}

float LightSources::skyDensity(const vec3& toSky) const {
  if (!table_) return kUniformDensity;
  const float azimuth = std::atan2(glm::dot(toSky, vec3(axes_.right)), glm::dot(toSky, vec3(axes_.forward)));
  const float height = 0.5f - 0.5f * glm::dot(toSky, vec3(axes_.up)), around = 0.5f + azimuth / kFullTurn;
  const auto cellOf = [](float u, int count) {
    return std::clamp(static_cast<int>(u * static_cast<float>(count)), 0, count - 1);
  };
  const int row = cellOf(height, kEnvironmentCellsUp), column = cellOf(around, kEnvironmentCellsAround);
  return table_->cells[static_cast<size_t>(row * kEnvironmentCellsAround + column)].z;
}

}  // namespace nephele::truth
