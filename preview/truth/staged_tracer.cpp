// The first order over the stage. Depends on preview/truth alone.
#include "preview/truth/staged_tracer.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace nephele::truth {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr int kMostMirrors = 2;  // one after another
constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Drawn by the cosine about `normal`.
dvec3 aboutNormal(const dvec3& normal, Random& random) {
  const double height = std::sqrt(1.0 - double{random.uniform()});
  const double wide = std::sqrt(std::max(0.0, 1.0 - height * height));
  const double turn = 2.0 * std::numbers::pi * double{random.uniform()};
  const dvec3 aside = std::abs(normal.z) < 0.5 ? dvec3(0.0, 0.0, 1.0) : dvec3(1.0, 0.0, 0.0);
  const dvec3 x = glm::normalize(glm::cross(normal, aside)), y = glm::cross(normal, x);
  return wide * std::cos(turn) * x + wide * std::sin(turn) * y + height * normal;
}

}  // namespace

/// Transmittance of the medium from a place along a direction.
vec3 StagedTracer::through(const dvec3& place, const vec3& along, double reach, Random& random,
                           uint64_t& looks) const {
  const auto entering = rays_.enter(place, dvec3(along), reach);
  return entering ? transmittance(medium_, entering->ray, random, looks) : vec3(1.0f);
}

/// What a surface reflects by Lambert's law: each light, and one direction to the sky.
vec3 StagedTracer::shade(const StageHit& hit, const dvec3& place, Random& random, uint64_t& looks) const {
  vec3 arriving(0.0f);
  const vec3 position = rays_.positionOf(place);
  for (size_t i = 0; i < lights_.count(); ++i) {
    const LitFrom lit = lights_.at(i, position);
    const float facing = static_cast<float>(glm::dot(hit.normal, dvec3(lit.toLight)));
    if (!(facing > 0.0f) || surfaces_.blocks(place, dvec3(lit.toLight), double{lit.reach})) continue;
    arriving += facing / std::numbers::pi_v<float> * lit.irradiance *
                through(place, lit.toLight, double{lit.reach}, random, looks);
  }
  if (lights_.hasSky()) {
    const dvec3 toSky = aboutNormal(hit.normal, random);
    if (!surfaces_.blocks(place, toSky, kEverywhere))
      arriving += lights_.sky(vec3(toSky)) * through(place, vec3(toSky), kEverywhere, random, looks);
  }
  return vec3(hit.albedo) * arriving;
}

StagedSample StagedTracer::trace(const dvec3& from, const dvec3& towards, const StratifiedPoint& point,
                                 Random& random, uint64_t& looks) const {
  StagedSample sample;
  vec3 left(1.0f);
  dvec3 origin = from, along = towards;
  for (int mirrors = 0; mirrors <= kMostMirrors; ++mirrors) {
    const auto hit = surfaces_.hit(origin, along);
    const auto entering = rays_.enter(origin, along, hit ? hit->distance : kEverywhere);
    PathSample scattered;
    if (entering)
      scattered = tracer_.trace(entering->ray, entering->along, {point.number, seedOf(point.seed, mirrors)},
                                random, looks);
    sample.radiance += left * scattered.radiance;
    if (mirrors == 0) {
      const float seen =
          hit ? (scattered.transmittance.x + scattered.transmittance.y + scattered.transmittance.z) / 3.0f
              : 0.0f;
      sample.transmittance = hit ? vec3(0.0f) : scattered.transmittance;
      sample.taken = scattered.taken + seen;
      sample.takenDistance =
          scattered.taken * (static_cast<float>(entering ? entering->before : 0.0) + scattered.distance) +
          seen * static_cast<float>(hit ? hit->distance : 0.0);
    }
    left *= scattered.transmittance;
    if (!hit) {
      if (mirrors > 0 && lights_.hasSky()) sample.radiance += left * lights_.sky(vec3(along));
      return sample;
    }
    origin += hit->distance * along;
    sample.radiance += left * shade(*hit, origin, random, looks);
    if (!(hit->mirror > 0.0)) return sample;
    left *= static_cast<float>(hit->mirror);
    along -= 2.0 * glm::dot(along, hit->normal) * hit->normal;
  }
  return sample;
}

}  // namespace nephele::truth
