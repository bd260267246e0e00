// The cases of the integrators' map. Depends on integrator_map.h, simulation.h.
#include "particles/integrator_map.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "particles/simulation.h"

namespace nephele {
namespace {

using glm::dvec3;

constexpr double kSeconds = 4.0;
constexpr double kSteps[] = {1.0 / 240.0, 1.0 / 60.0, 1.0 / 24.0, 0.25, 1.0};
// Where no closed form is known, truth is a run of steps this much shorter than the shortest.
constexpr double kFineStep = 1.0 / 7680.0;
// What rounding and a half-turned circle may add to the farthest that truth gets.
constexpr double kRoom = 1.05;

/// One particle under one force, and where it truly ends.
struct Case {
  std::string axis;
  double strength = 0.0;
  dvec3 start{0.0}, velocity{0.0};
  Forces forces;
  /// Place after `seconds`; none: a finely stepped run says.
  std::function<dvec3(double)> truth;
  /// What two places are told apart by; none: their distance.
  std::function<double(const dvec3&, const dvec3&)> apart;
  double reach = 0.0;  // how far from the origin these forces can bring it; 0: as far as truth gets
};

struct Path {
  dvec3 end{0.0};
  double farthest = 0.0;  // from the origin, where all forces have their centre
};

/// Throws SimulationError.
Path pathOf(const Case& c, double step) {
  ParticleSystem system;
  Emitter emitter;
  emitter.shape = EmitterShape::point;
  emitter.center = c.start;
  emitter.velocity = c.velocity;
  emitter.bursts = {{0.0, 1.0}};
  emitter.life = 2.0 * kSeconds;
  system.emitters = {emitter};
  system.forces = c.forces;
  system.substeps = 1;
  Simulation simulation(system, {nullptr}, {1.0 / step, 2, 0});
  Path path;
  for (int n = 0; n < int(std::lround(kSeconds / step)); ++n) {
    simulation.step();
    const ParticleArrays& p = simulation.particles();
    path.end = {double(p.x.at(0)), double(p.y.at(0)), double(p.z.at(0))};
    path.farthest = std::max(path.farthest, glm::length(path.end));
  }
  return path;
}

Path truthOf(const Case& c) {
  if (!c.truth) return pathOf(c, kFineStep);
  Path path;
  constexpr int kLooks = 4000;
  for (int n = 1; n <= kLooks; ++n) {
    path.end = c.truth(kSeconds * n / kLooks);
    path.farthest = std::max(path.farthest, glm::length(path.end));
  }
  return path;
}

/// Drag that stops a thrown particle and lets it sink: v' = g − k v.
Case dragCase(double k) {
  constexpr double kGravity = -9.81;
  Case c{"drag, 1/s", k, {}, {3.0, 0.0, 4.0}, {}, {}, {}, 0.0};
  c.forces.drag = k;
  c.forces.gravity = {0.0, 0.0, kGravity};
  const dvec3 thrown = c.velocity, sinking(0.0, 0.0, kGravity / k);
  c.truth = [=](double t) { return sinking * t + (thrown - sinking) * (-std::expm1(-k * t) / k); };
  return c;
}

/// A vortex keeps its particles on circles: it is the radius that is held against truth.
Case vortexCase(double rate) {
  Case c{"vortex, radians per second", rate, {1.0, 0.0, 0.0}, {}, {}, {}, {}, 0.0};
  c.forces.vortices = {Vortex{dvec3(0.0), {0.0, 0.0, 1.0}, rate, 2.0}};
  const double turning = rate * std::exp(-0.25);  // (1/2)²
  c.truth = [=](double t) { return dvec3(std::cos(turning * t), std::sin(turning * t), 0.0); };
  c.apart = [](const dvec3& a, const dvec3& b) { return std::abs(glm::length(a) - glm::length(b)); };
  return c;
}

/// A particle thrown outwards in a vortex, while drag stops it: turning changes no distance from the axis.
Case thrownVortexCase(double rate) {
  Case c{
      "vortex and drag of 2/s, radians per second", rate, {0.5, 0.0, 0.0}, {2.0, 0.0, 0.0}, {}, {}, {}, 0.0};
  c.forces.vortices = {Vortex{dvec3(0.0), {0.0, 0.0, 1.0}, rate, 2.0}};
  c.forces.drag = 2.0;
  c.reach = glm::length(c.start) + glm::length(c.velocity) / c.forces.drag;
  return c;
}

/// A spring without damping: x'' = −s x (its fall-off is far away).
Case springCase(double strength) {
  constexpr double kFar = 1e4;
  Case c{"attractor, 1/s²", strength, {1.0, 0.0, 0.0}, {}, {}, {}, {}, 0.0};
  c.forces.attractors = {Attractor{dvec3(0.0), strength, kFar}};
  const double rate = std::sqrt(strength);
  c.truth = [=](double t) { return dvec3(std::cos(rate * t), 0.0, 0.0); };
  return c;
}

/// A spring under drag so stiff that it creeps home: no closed form is needed where steps can be short.
Case creepingCase(double drag) {
  Case c{"attractor of 100/s² and drag, 1/s", drag, {1.0, 0.0, 0.0}, {}, {}, {}, {}, 0.0};
  c.forces.attractors = {Attractor{dvec3(0.0), 100.0, 1e4}};
  c.forces.drag = drag;
  return c;
}

/// A wind that leaves every range.
Case runawayCase(double gravity) {
  Case c{"gravity, world units per second²", gravity, {}, {}, {}, {}, {}, 0.0};
  c.forces.gravity = {0.0, 0.0, -gravity};
  c.truth = [=](double t) { return dvec3(0.0, 0.0, -0.5 * gravity * t * t); };
  return c;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double k : {1.0, 10.0, 100.0, 1e4}) all.push_back(dragCase(k));
  for (const double rate : {1.0, 10.0, 100.0, 1e4}) all.push_back(vortexCase(rate));
  for (const double rate : {1.0, 10.0, 100.0}) all.push_back(thrownVortexCase(rate));
  for (const double strength : {1.0, 100.0, 1e4}) all.push_back(springCase(strength));
  for (const double drag : {1.0, 100.0, 1e4}) all.push_back(creepingCase(drag));
  for (const double gravity : {10.0, 1e9}) all.push_back(runawayCase(gravity));
  return all;
}

IntegratorRow rowOf(const Case& c, double step, const Path& truth) {
  IntegratorRow row{c.axis, c.strength, step, {}, IntegratorVerdict::grows, {}};
  try {
    const Path path = pathOf(c, step);
    const double apart = c.apart ? c.apart(path.end, truth.end) : glm::length(path.end - truth.end);
    row.error = apart / truth.farthest;
    if (*row.error <= kTrustedIntegratorError)
      row.verdict = IntegratorVerdict::trusted;
    else if (path.farthest <= kRoom * std::max(c.reach, truth.farthest))
      row.verdict = IntegratorVerdict::bounded;
  } catch (const SimulationError& refusal) {
    row.verdict = IntegratorVerdict::refused;
    row.sentence = refusal.what();
  }
  return row;
}

}  // namespace

std::vector<IntegratorRow> integratorMap() {
  std::vector<IntegratorRow> rows;
  for (const Case& c : cases()) {
    const Path truth = truthOf(c);
    for (const double step : kSteps) rows.push_back(rowOf(c, step, truth));
  }
  return rows;
}

}  // namespace nephele
