// From a system as it is written to the rows that the shared text takes, and how many particles are born
// when. Depends on particles.h.
#include <algorithm>
#include <cmath>

#include "particles/particles.h"

namespace nephele {
namespace {

using motion::vec3, motion::vec4, motion::ivec4;

vec4 row(const glm::dvec3& v, double w = 0.0) { return {float(v.x), float(v.y), float(v.z), float(w)}; }

glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

void setCurve(const ParticleCurve& curve, vec4* rows, int& count) {
  count = int(curve.size());
  for (size_t n = 0; n < curve.size(); ++n)
    rows[n] = vec4(float(curve[n][0]), float(curve[n][1]), 0.0f, 0.0f);
}

/// ∫ of the rate from 0 to `time`, by the trapezes of its pieces.
double integralOf(const ParticleCurve& rate, double time) {
  double sum = 0.0, x = 0.0, y = rate.front()[1];
  for (const auto& point : rate) {
    if (point[0] >= time) {
      const double there = point[0] > x ? y + (point[1] - y) * ((time - x) / (point[0] - x)) : point[1];
      return sum + 0.5 * (y + there) * (time - x);
    }
    sum += 0.5 * (y + point[1]) * (point[0] - x);
    x = point[0];
    y = point[1];
  }
  return sum + y * (time - x);
}

}  // namespace

motion::ParticleParameters parametersOf(const ParticleSystem& system, int upAxis, uint32_t seed) {
  const Forces& f = system.forces;
  motion::ParticleParameters p{};
  glm::dvec3 up(0.0);
  up[upAxis] = 1.0;
  p.gravity = row(f.gravity, f.drag);
  p.wind = row(f.wind, f.cooling);
  p.up = row(up, f.buoyancy);
  p.curl = vec4(float(f.curlSpeed), float(1.0 / f.curlCellSize), float(f.curlGain), 0.0f);
  p.curlScroll = row(f.curlScroll);
  p.ground = vec4(float(f.groundHeight), float(f.bounce), float(f.friction), 0.0f);
  p.neighbours = vec4(float(f.neighbourReach), float(f.cohesion), float(f.separation), 0.0f);
  p.counts =
      ivec4(int(f.vortices.size()), int(f.attractors.size()), f.curlSpeed > 0.0 ? int(f.curlOctaves) : 0,
            int(motion::hashBits(uint32_t(f.curlSeed) ^ motion::hashBits(seed))));
  p.flags.x = f.ground ? 1 : 0;
  setCurve(system.sizeOverLife, p.sizeCurve, p.flags.y);
  setCurve(system.densityOverLife, p.densityCurve, p.flags.z);
  for (size_t n = 0; n < f.vortices.size(); ++n) {
    const Vortex& v = f.vortices[n];
    p.vortices[n] = {row(v.center, v.rate), row(unit(v.axis), v.radius)};
  }
  for (size_t n = 0; n < f.attractors.size(); ++n) {
    const Attractor& a = f.attractors[n];
    p.attractors[n] = {row(a.center, a.strength), vec4(float(a.radius), 0.0f, 0.0f, 0.0f)};
  }
  return p;
}

motion::EmitterParameters parametersOf(const Emitter& e, size_t number, uint32_t seed) {
  motion::EmitterParameters p{};
  p.center = row(e.center, e.radiusVariation);
  p.size = row(e.shape == EmitterShape::box ? e.halfSize : glm::dvec3(e.radius), e.density);
  p.axis = row(unit(e.axis), e.densityVariation);
  p.velocity = row(e.velocity, e.temperature);
  p.motion = vec4(float(e.outward), float(e.spread), float(e.life), float(e.lifeVariation));
  p.born = vec4(float(e.particleRadius), 0.0f, 0.0f, 0.0f);
  const bool sites = e.shape == EmitterShape::mesh || e.shape == EmitterShape::points;
  const uint32_t mixed =
      motion::hashBits(uint32_t(e.seed) ^ motion::hashBits(uint32_t(number) ^ motion::hashBits(seed)));
  p.kind = ivec4(sites ? motion::kEmitSites : int(e.shape), e.surface ? 1 : 0, int(mixed), 0);
  return p;
}

uint64_t bornUntil(const Emitter& emitter, double time) {
  double born = emitter.rate.empty() ? 0.0 : std::floor(integralOf(emitter.rate, time));
  for (const auto& burst : emitter.bursts)
    if (burst[0] <= time) born += std::floor(burst[1]);
  return uint64_t(born);
}

}  // namespace nephele
