// The path tracer's estimators. Depends on preview/truth alone.
#include "preview/truth/path_tracer.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

namespace nephele::truth {
namespace {

using glm::vec3;

// Dimensions of the stratified points; 0 and 1 lie in the pixel.
enum Dimension { kPlace = 2, kChoice = 3, kTurn1 = 4, kTurn2 = 5, kChannel = 6 };

constexpr float kNowhere = std::numeric_limits<float>::infinity();

float largest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

/// A scattering that light is gathered at.
struct PathTracer::Vertex {
  vec3 position;
  vec3 along;   // direction of flight that led here, unit, world axes
  vec3 weight;  // of the light scattered here
  float scale;  // of the first vertex's weight, for roulette
  int order = 0;
  std::array<float, 3> drawn;  // choice of a light; two numbers for directions
};

vec3 PathTracer::lightFromSources(const Vertex& vertex, float choice, Random& random, uint64_t& looks) const {
  if (lights_.count() == 0) return vec3(0.0f);
  // One light, chosen by what it would give without a medium.
  const auto unshadowed = [&](size_t i) {
    const LitFrom lit = lights_.at(i, vertex.position);
    return std::pair(lit, vertex.weight * lit.irradiance * phase_.density(vertex.along, lit.toLight));
  };
  float all = 0.0f;
  for (size_t i = 0; i < lights_.count(); ++i) all += largest(unshadowed(i).second);
  if (!(all > 0.0f)) return vec3(0.0f);
  float rest = choice * all;
  size_t i = 0;
  auto [lit, light] = unshadowed(0);
  while (i + 1 < lights_.count() && rest >= largest(light)) {
    rest -= largest(light);
    std::tie(lit, light) = unshadowed(++i);
  }
  const float share = largest(light) / all;
  if (!(share > 0.0f) || wayFrom(vertex.position, lit.toLight) < lit.reach) return vec3(0.0f);
  const TrackedRay ray{vertex.position, medium_.indexFromWorld * lit.toLight, lit.reach};
  return light / share * transmittance(medium_, ray, random, looks);
}

vec3 PathTracer::lightFromSky(const Vertex& vertex, float u1, float u2, Random& random,
                              uint64_t& looks) const {
  const SkyDirection drawn = lights_.sampleSky(u1, u2, random);
  const float phase = phase_.density(vertex.along, drawn.toSky);
  // The balance heuristic [Veach 1995]: phase/density · density/(density + phase).
  const vec3 light = vertex.weight * lights_.sky(drawn.toSky) * (phase / (drawn.density + phase));
  if (!(largest(light) > 0.0f) || wayFrom(vertex.position, drawn.toSky) < kNowhere) return vec3(0.0f);
  const TrackedRay ray{vertex.position, medium_.indexFromWorld * drawn.toSky};
  return light * transmittance(medium_, ray, random, looks);
}

/// Russian roulette: paths that carry less than a fifth of what they began with end in proportion.
bool PathTracer::survives(Vertex& vertex, Random& random) const {
  constexpr float kShare = 0.2f;
  const float chance = largest(vertex.weight) / (kShare * vertex.scale);
  if (chance >= 1.0f) return true;
  if (random.uniform() >= chance) return false;
  vertex.weight /= chance;
  return true;
}

/// What a place emits, seen by light of weight `arriving` that is taken there: of that the absorbed share.
vec3 PathTracer::emitted(const vec3& arriving, const vec3& position) const {
  return arriving * absorbedShare(medium_) * emitter_->radiance(position);
}

/// Follows the path to its next scattering; what it meets instead is added to `radiance`. False where it
/// ends.
bool PathTracer::goOn(Vertex& vertex, vec3& radiance, Random& random, uint64_t& looks) const {
  const bool last = vertex.order == settings_.bounces;
  if (last && !lights_.hasSky() && emitter_ == nullptr) return false;
  const vec3 next = phase_.sample(vertex.along, vertex.drawn[1], vertex.drawn[2]);
  const float way = wayFrom(vertex.position, next);
  const bool toSky = lights_.hasSky() && !(way < kNowhere);
  const auto share = [&] {  // of the sky's light that is left to be met by chance
    if (!settings_.lightSampling) return 1.0f;
    const float phase = phase_.density(vertex.along, next);
    return phase / (phase + lights_.skyDensity(next));
  };
  TrackedRay ray{vertex.position, medium_.indexFromWorld * next, way};
  if (last && settings_.lightSampling && emitter_ == nullptr) {
    if (toSky)
      radiance += vertex.weight * share() * lights_.sky(next) * transmittance(medium_, ray, random, looks);
    return false;
  }
  vec3 arriving(0.0f);
  if (!nextCollision(medium_, ray, vertex.weight, random, looks, &arriving)) {
    if (toSky) radiance += vertex.weight * share() * lights_.sky(next);
    return false;
  }
  if (emitter_ != nullptr) radiance += emitted(arriving, ray.origin);
  vertex.position = ray.origin;
  vertex.along = next;
  ++vertex.order;
  return !last && survives(vertex, random);
}

vec3 PathTracer::gather(Vertex& vertex, Random& random, uint64_t& looks) const {
  vec3 radiance(0.0f);
  for (;;) {
    if (settings_.lightSampling) {
      radiance += lightFromSources(vertex, vertex.drawn[0], random, looks);
      if (lights_.hasSky()) radiance += lightFromSky(vertex, vertex.drawn[1], vertex.drawn[2], random, looks);
      // The path goes on by the same two numbers: what both find is added, never multiplied, so each stays
      // unbiased.
    }
    if (!goOn(vertex, radiance, random, looks)) return radiance;
    for (float& number : vertex.drawn) number = random.uniform();
  }
}

PathSample PathTracer::trace(const TrackedRay& ray, const vec3& along, const StratifiedPoint& point,
                             Random& random, uint64_t& looks) const {
  const auto draw = [&](Dimension dimension) { return stratified(dimension, point.number, point.seed); };
  PathSample sample;
  Vertex vertex;
  vertex.along = along;
  if (settings_.lightSampling) {
    const float channel = medium_.grey ? 0.0f : draw(kChannel);
    const FirstScattering first = firstScattering(medium_, ray, draw(kPlace), channel, random, looks);
    sample.transmittance = first.transmittance;
    if (!first.found) return sample;
    sample.taken = first.taken;
    sample.distance = first.distance;
    vertex.position = first.position;
    vertex.weight = first.weight;
    if (emitter_ != nullptr) sample.radiance = first.absorbed * emitter_->radiance(first.position);
  } else {
    TrackedRay tracked = ray;
    vertex.weight = vec3(1.0f);
    vec3 arriving(0.0f);
    const bool found = nextCollision(medium_, tracked, vertex.weight, random, looks, &arriving);
    sample.transmittance = vec3(found ? 0.0f : 1.0f);
    if (!found) return sample;
    sample.taken = 1.0f;
    if (emitter_ != nullptr) sample.radiance = emitted(arriving, tracked.origin);
    vertex.position = tracked.origin;
    sample.distance = glm::length(medium_.worldFromIndex * (tracked.origin - ray.origin));
  }
  vertex.scale = largest(vertex.weight);
  if (!(vertex.scale > 0.0f)) return sample;
  vertex.drawn = {lights_.count() > 1 ? draw(kChoice) : 0.0f, draw(kTurn1), draw(kTurn2)};
  sample.radiance += gather(vertex, random, looks);
  return sample;
}

}  // namespace nephele::truth
