// Bounds of a live simulation, and a small simulation that finds its box. Depends on live_plan.h.
#include "particles/live_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace nephele {
namespace {

double largestOf(const ParticleCurve& curve, double otherwise) {
  double largest = curve.empty() ? otherwise : 0.0;
  for (const auto& point : curve) largest = std::max(largest, point[1]);
  return largest;
}

/// Births that may be alive at a time: those of a life and two steps at the highest rate, and all bursts;
/// never more than are ever born.
double mostAlive(const Emitter& e, double stepSeconds) {
  double bursts = 0.0;
  for (const auto& burst : e.bursts) bursts += std::floor(burst[1]);
  double most = bursts + std::ceil(largestOf(e.rate, 0.0) * (e.life + 2.0 * stepSeconds)) + 1.0;
  if (!e.rate.empty() && e.rate.back()[1] == 0.0)
    most = std::min(most, bursts + double(bornUntil(e, e.rate.back()[0])) + 1.0);
  return most;
}

/// The same system with so few births that it is moved in a moment; particles do not see each other.
ParticleSystem thinned(ParticleSystem system) {
  constexpr double kParticles = 400.0;
  double alive = 0.0;
  for (const Emitter& e : system.emitters) alive += mostAlive(e, 0.0);
  const double share = std::min(1.0, kParticles / std::max(alive, 1.0));
  for (Emitter& e : system.emitters) {
    for (auto& point : e.rate) point[1] *= share;
    for (auto& burst : e.bursts)
      if (burst[1] >= 1.0) burst[1] = std::max(1.0, std::floor(burst[1] * share));
  }
  system.forces.neighbourReach = system.forces.cohesion = system.forces.separation = 0.0;
  return system;
}

}  // namespace

std::vector<SlotRing> slotRings(const ParticleSystem& system, double stepSeconds) {
  std::vector<SlotRing> rings;
  double total = 0.0;
  for (const Emitter& e : system.emitters) {
    if (e.shape == EmitterShape::mesh || e.shape == EmitterShape::points)
      throw SimulationError("an emitter emits from '" + e.file +
                            "', which the bake alone reads: not simulated live");
    const double most = mostAlive(e, stepSeconds);
    if (total + most > double(kMostLiveParticles))
      throw SimulationError("up to " + std::to_string(std::llround(total + most)) +
                            " particles may be alive at a time; at most " +
                            std::to_string(kMostLiveParticles) + " are simulated live");
    rings.push_back({uint32_t(total), uint32_t(most)});
    total += most;
  }
  return rings;
}

double mostMass(const ParticleSystem& system, const std::vector<SlotRing>& rings) {
  double mass = 0.0;
  for (size_t n = 0; n < rings.size(); ++n) {
    const Emitter& e = system.emitters[n];
    const double r = e.particleRadius;
    mass += double(rings[n].count) * e.density * (4.0 / 3.0 * std::numbers::pi) * r * r * r;
  }
  return mass * largestOf(system.densityOverLife, 1.0);
}

std::vector<std::string> leftOutLive(const ParticleSystem& system) {
  std::vector<std::string> sentences;
  if (system.erosion > 0.0) sentences.push_back("live particles are not eroded by noise; baked ones are");
  if (!system.grids.empty())
    sentences.push_back("live particles make density alone; the other grids are baked");
  return sentences;
}

std::optional<MotionBox> motionBox(const ParticleSystem& system, const SimulationSettings& settings,
                                   int64_t frames) {
  if (system.hasBox()) return MotionBox{system.boxMin, system.boxMax};
  ParticleSystem few = thinned(system);
  Simulation simulation(few, std::vector<SiteSourcePtr>(few.emitters.size()), settings);
  std::optional<MotionBox> box;
  const auto look = [&] {
    const ParticleView view = simulation.view();
    for (size_t n = 0; n < view.size(); ++n) {
      const glm::dvec3 place(view.x[n], view.y[n], view.z[n]), reach(double(view.radius[n]));
      if (!box) box = MotionBox{place - reach, place + reach};
      box->low = glm::min(box->low, place - reach);
      box->high = glm::max(box->high, place + reach);
    }
  };
  const int64_t first = system.prewarm * system.substeps;
  for (int64_t step = 0; step < first + frames * system.substeps; ++step) {
    if (step >= first && step % system.substeps == 0) look();
    simulation.step();
  }
  look();
  return box;
}

}  // namespace nephele
