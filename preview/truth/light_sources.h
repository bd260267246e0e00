// Suns, points and the environment as the path tracer samples them. Depends on
// preview/viewed_scene.h, scene, GLM and preview/truth/tracking.h.
#pragma once

#include <vector>

#include "preview/truth/tracking.h"
#include "preview/viewed_scene.h"
#include "scene/sky.h"

namespace nephele::truth {

/// A light from one exact direction at a place: a sun or a point.
struct LitFrom {
  glm::vec3 toLight{0.0f};     // unit, world axes
  float reach = 0.0f;          // world distance
  glm::vec3 irradiance{0.0f};  // on a plane facing the light, without a medium
};

/// A direction to the environment.
struct SkyDirection {
  glm::vec3 toSky{0.0f};  // unit, world axes
  float density = 0.0f;   // with which it was drawn, per steradian
};

/// Lights of a scene, in the coordinates of tracking. Safe to use from many threads.
class LightSources {
 public:
  /// `worldCorner`: the corner of the brick grid. The view outlives the sources.
  LightSources(const ViewedScene& view, const TrackedMedium& medium, const glm::dvec3& worldCorner);

  size_t count() const { return lights_.size(); }
  /// Light `i` at a place (voxels from the corner of the brick grid). A point at the place itself gives
  /// nothing.
  LitFrom at(size_t i, const glm::vec3& position) const;

  bool hasSky() const { return hasSky_; }
  /// The environment's radiance from a unit direction.
  glm::vec3 sky(const glm::vec3& toSky) const;
  /// A direction drawn by its share of the environment's light, from two numbers in [0, 1) and, where that is
  /// uneven, more.
  SkyDirection sampleSky(float u1, float u2, Random& random) const;
  /// The density of sampleSky at a direction.
  float skyDensity(const glm::vec3& toSky) const;

 private:
  struct Source {
    bool isSun;
    glm::vec3 place;  // sun: unit vector to it. Point: position
    glm::vec3 power;  // sun: irradiance. Point: intensity
  };
  std::vector<Source> lights_;
  glm::mat3 worldFromIndex_;
  const ViewedScene& view_;
  bool hasSky_;
  std::shared_ptr<const EnvironmentMap> table_;  // for drawing directions; nullptr: uniformly
  SkyAxes axes_;                                 // of the table
};

}  // namespace nephele::truth
