// Live particles on the driver against the same system on the CPU: places after steps, slots, changes of the
// system.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "preview/gpu/live_motion.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr double kVoxel = 0.02;
// The issue's: after 24 steps a particle is where the CPU has it within a thousandth of a voxel.
constexpr int kSteps = 24;
constexpr double kPlaceVoxels = 1e-3;

/// Every force and every emitter's shape that is simulated live.
ParticleSystem busySystem() {
  ParticleSystem s;
  for (const EmitterShape shape :
       {EmitterShape::point, EmitterShape::sphere, EmitterShape::box, EmitterShape::disc}) {
    Emitter e;
    e.shape = shape;
    e.center = {0.1 * static_cast<double>(shape), 0.05, 0.2};
    e.radius = 0.2;
    e.halfSize = {0.1, 0.2, 0.05};
    e.axis = {0.2, 0.1, 1.0};
    e.surface = shape == EmitterShape::box;
    e.rate = {{0.0, 500.0}, {0.5, 1500.0}};
    e.bursts = {{0.0, 100.0}, {0.3, 57.0}};
    e.velocity = {0.1, 0.0, 0.6};
    e.outward = 0.2;
    e.spread = 0.3;
    e.particleRadius = 0.03;
    e.radiusVariation = 0.5;
    e.densityVariation = 0.3;
    e.life = 0.6;
    e.lifeVariation = 0.7;
    e.temperature = 1.5;
    e.seed = 3;
    s.emitters.push_back(e);
  }
  Forces& f = s.forces;
  f.gravity = {0.0, 0.0, -2.0};
  f.wind = {0.3, 0.1, 0.0};
  f.drag = 1.5;
  f.buoyancy = 1.2;
  f.cooling = 0.7;
  f.curlSpeed = 0.4;
  f.curlCellSize = 0.3;
  f.curlOctaves = 3;
  f.curlScroll = {0.0, 0.1, -0.5};
  f.ground = true;
  f.groundHeight = 0.05;
  f.vortices = {{{0.2, 0.0, 0.0}, {0.0, 0.3, 1.0}, 3.0, 0.5}};
  f.attractors = {{{0.0, 0.0, 0.5}, 4.0, 0.4}};
  s.sizeOverLife = {{0.0, 0.6}, {0.3, 1.2}, {1.0, 2.0}};
  s.densityOverLife = {{0.0, 1.0}, {1.0, 0.2}};
  return s;
}

constexpr SimulationSettings kSettings{24.0, 2, 7};

struct Agreement {
  double worst = 0.0;       // voxels
  double otherWorst = 0.0;  // of ages, seconds, and of radii and masses at birth, relative
  size_t pairs = 0, missing = 0;
};

/// Pairs slots and the CPU's particles by the numbers of their births.
Agreement compare(const LiveMotion& live, const Simulation& simulation) {
  const std::vector<LiveParticle> slots = live.read();
  const ParticleArrays& p = simulation.particles();
  Agreement result;
  size_t alive = 0;
  for (const LiveParticle& slot : slots) alive += slot.place.w < slot.motion.w ? 1 : 0;
  for (size_t n = 0; n < p.size(); ++n) {
    const size_t emitter = p.id[n] >> 28;
    const uint32_t number = p.id[n] & 0x0fffffffu;
    const SlotRing& ring = live.rings()[emitter];
    const uint32_t at = number % ring.count;
    const LiveParticle& slot = slots[ring.first + at];
    EXPECT_EQ(live.birthOf(emitter, ring.first + at), number);
    if (!(slot.place.w < slot.motion.w)) {
      ++result.missing;  // one that dies within rounding of this step
      continue;
    }
    const glm::vec3 apart = glm::vec3(slot.place) - glm::vec3(p.x[n], p.y[n], p.z[n]);
    result.worst = std::max(result.worst, static_cast<double>(glm::length(apart)) / kVoxel);
    ++result.pairs;
    for (const auto& [ours, theirs, unit] :
         {std::array{slot.born.x, p.radius[n], p.radius[n]}, std::array{slot.born.y, p.mass[n], p.mass[n]},
          std::array{slot.place.w, p.age[n], 1.0f}})
      result.otherWorst = std::max(result.otherWorst, std::abs(double{ours} - double{theirs}) / double{unit});
  }
  EXPECT_LE(alive, result.pairs + 2);
  return result;
}

Agreement afterSteps(const ParticleSystem& system, const std::vector<TextChange>& changes = {}) {
  LiveMotion live(system, kSettings, changes);
  Simulation simulation(system, std::vector<SiteSourcePtr>(system.emitters.size()), kSettings);
  for (int step = 0; step < kSteps; ++step) {
    live.step();
    simulation.step();
  }
  return compare(live, simulation);
}

TEST(GlLive, PlacesAreTheCpusAfter24Steps) {
  needContext();
  const Agreement a = afterSteps(busySystem());
  std::printf("%zu particles, farthest apart %.2e voxels, %zu died within rounding\n", a.pairs, a.worst,
              a.missing);
  EXPECT_GT(a.pairs, 1500u);
  EXPECT_LE(a.missing, 2u);
  EXPECT_LT(a.worst, kPlaceVoxels);
  EXPECT_LT(a.otherWorst, 1e-5);
}

TEST(GlLive, ADifferentMotionIsNoticed) {
  needContext();
  const TextChange mutants[] = {
      {"shared/particles.glsl", "time + 0.5f * dt) * dt;", "time) * dt;"},
      {"shared/particles.glsl", "vortexRate(particles.vortices[n], dot(arm, arm)) * dt);",
       "vortexRate(particles.vortices[n], dot(arm, arm)) * dt * 1.001f);"},
      {"particles_move.comp", "+ 0.5) / float(ring.w", "+ 0.25) / float(ring.w"},
  };
  for (const TextChange& mutant : mutants) {
    const double worst = afterSteps(busySystem(), {mutant}).worst;
    std::printf("%s: %.2e voxels\n", mutant.to.c_str(), worst);
    EXPECT_GT(worst, kPlaceVoxels) << mutant.to;
  }
}

TEST(GlLive, NeighboursPullAndPushAsOnTheCpu) {
  needContext();
  ParticleSystem system = busySystem();
  system.forces.neighbourReach = 0.08;
  system.forces.cohesion = 30.0;
  system.forces.separation = 3.0;
  const Agreement a = afterSteps(system);
  std::printf("%zu particles among neighbours, farthest apart %.2e voxels\n", a.pairs, a.worst);
  EXPECT_GT(a.pairs, 1500u);
  EXPECT_LT(a.worst, kPlaceVoxels);
  EXPECT_GT(afterSteps(system, {{"particles_neighbours.comp", "for (int n = 0; n < 27; ++n) addBucket",
                                 "for (int n = 1; n < 27; ++n) addBucket"}})
                .worst,
            kPlaceVoxels);
}

TEST(GlLive, SlotsAreTakenAgainAndNobodyIsLost) {
  needContext();
  const ParticleSystem system = busySystem();
  LiveMotion live(system, kSettings);
  Simulation simulation(system, std::vector<SiteSourcePtr>(system.emitters.size()), kSettings);
  constexpr int kLong = 150;  // five lives
  for (int step = 0; step < kLong; ++step) {
    live.step();
    simulation.step();
  }
  EXPECT_GT(simulation.ledger().countDied, 2u * live.slotCount());
  const Agreement a = compare(live, simulation);
  EXPECT_LE(a.missing, 4u);
  live.reset();
  EXPECT_EQ(live.stepsDone(), 0u);
  size_t alive = 0;
  for (const LiveParticle& p : live.read()) alive += p.place.w < p.motion.w ? 1 : 0;
  EXPECT_EQ(alive, 400u);  // the bursts at time 0
}

TEST(GlLive, OtherForcesDoNotBeginAnewAndOtherRatesDo) {
  needContext();
  ParticleSystem system = busySystem();
  LiveMotion live(system, kSettings);
  live.step();
  system.forces.gravity.z = 3.0;
  EXPECT_FALSE(live.setSystem(system));
  EXPECT_EQ(live.stepsDone(), 1u);
  system.emitters[0].rate = {{0.0, 900.0}};
  EXPECT_TRUE(live.setSystem(system));
  EXPECT_EQ(live.stepsDone(), 0u);
  system.emitters[0].shape = EmitterShape::mesh;
  EXPECT_THROW(live.setSystem(system), SimulationError);
  system.emitters[0].shape = EmitterShape::point;
  system.emitters[0].rate = {{0.0, 1e9}};
  EXPECT_THROW(live.setSystem(system), SimulationError);
}

}  // namespace
}  // namespace nephele::testing_gl
