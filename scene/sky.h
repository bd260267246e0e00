// Radiance of the environment in a direction, in double precision: what the path tracer, tests and pictures
// read. The march has its own text in shaders/shared/environment.glsl. Depends on scene alone.
#pragma once

#include "scene/environment_map.h"
#include "scene/scene.h"

namespace nephele {

/// Axes of a lat-long in the world: unit vectors, right-handed (right × forward = up).
struct SkyAxes {
  glm::dvec3 right, forward, up;  // forward: where the centre column looks
};

/// Axes for the world's `up` (unit) and a rotation in radians: forward is +Y where Z is up and −Z where Y is
/// up, turned about up, counter-clockwise seen from above.
SkyAxes skyAxes(const glm::dvec3& up, double rotation);

/// The ramp's constants of shape.
struct RampShape {
  double skyPower;      // n: above, the horizon's share is (1 − sin elevation)^n
  double groundPower;   // below, (1 + sin elevation)^m
  double groundFactor;  // of the ground's colour
};

/// Cloudiness c in [0, 1]: n from 5 (white near the horizon) to ½ (white nearly everywhere), m = 24, the
/// ground reflects 1 − 0.6 c of its clear-sky radiance.
RampShape rampShape(double cloudiness);

/// Radiance from `direction` (unit, world, away from the viewer). `map` is looked at where the kind is exr,
/// and must then be given. Thread-safe.
glm::dvec3 skyRadiance(const Environment& environment, const EnvironmentMap* map, const glm::dvec3& up,
                       const glm::dvec3& direction);

/// The mean of skyRadiance over all directions, of a constant environment or a ramp: in closed form.
glm::dvec3 meanSkyRadiance(const Environment& environment);

}  // namespace nephele
