// The simulation's promises: same on any number of threads, restarts that change nothing, births and deaths
// that add up, refusals.
#include "particles/simulation.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "particles/neighbour_grid.h"

namespace nephele {
namespace {

ParticleSystem busy() {
  ParticleSystem s;
  Emitter e;
  e.rate = {{0.0, 3000.0}};
  e.bursts = {{0.2, 500.0}};
  e.velocity = {0, 0, 1};
  e.spread = 0.5;
  e.particleRadius = 0.05;
  e.radiusVariation = 0.4;
  e.life = 0.6;
  e.lifeVariation = 0.5;
  e.temperature = 1.0;
  s.emitters = {e, e};
  s.emitters[1].shape = EmitterShape::box;
  s.emitters[1].surface = true;
  s.emitters[1].outward = 0.4;
  s.forces.gravity = {0, 0, -2};
  s.forces.drag = 0.5;
  s.forces.buoyancy = 3.0;
  s.forces.cooling = 1.0;
  s.forces.curlSpeed = 0.3;
  s.forces.curlOctaves = 2;
  s.forces.neighbourReach = 0.15;
  s.forces.cohesion = 5.0;
  s.forces.separation = 2.0;
  s.forces.ground = true;
  s.forces.groundHeight = -0.4;
  s.forces.vortices = {{{0, 0, 0}, {0, 0, 1}, 3.0, 1.0}};
  s.forces.attractors = {{{0, 0, 1}, 4.0, 1.0}};
  s.sizeOverLife = {{0.0, 0.5}, {1.0, 2.0}};
  s.densityOverLife = {{0.5, 1.0}, {1.0, 0.0}};
  return s;
}

Simulation fresh(const ParticleSystem& system) {
  return Simulation(system, std::vector<SiteSourcePtr>(system.emitters.size()), {24.0, 2, 9});
}

TEST(Simulation, IsTheSameOnAnyNumberOfThreads) {
  std::string states[3];
  for (const int threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    Simulation simulation = fresh(busy());
    for (int n = 0; n < 24; ++n) simulation.step();
    states[threads / 2] = simulation.save();
  }
  EXPECT_GT(states[0].size(), 48u * 2000u);
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(states[0], states[2]);
}

TEST(Simulation, GoesOnFromACheckpointAsIfItHadNeverStopped) {
  Simulation whole = fresh(busy());
  for (int n = 0; n < 10; ++n) whole.step();
  Simulation second = fresh(busy());
  ASSERT_TRUE(second.load(whole.save()));
  for (int n = 0; n < 10; ++n) {
    whole.step();
    second.step();
  }
  EXPECT_EQ(whole.save(), second.save());
  std::string damaged = whole.save();
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_FALSE(second.load(damaged));
  EXPECT_FALSE(second.load(std::string_view(damaged).substr(0, 90)));
  EXPECT_EQ(whole.save(), second.save());
}

TEST(Simulation, BirthsAndDeathsAddUp) {
  Simulation simulation = fresh(busy());
  for (int n = 0; n < 48; ++n) {
    simulation.step();
    const BirthLedger& ledger = simulation.ledger();
    double alive = 0.0;
    for (const float m : simulation.particles().mass) alive += double(m);
    ASSERT_NEAR(ledger.emitted - ledger.died, alive, 1e-9 * ledger.emitted);
    ASSERT_EQ(ledger.countEmitted - ledger.countDied, simulation.particles().size());
  }
  // 2 emitters · (3000/s for one second + 500)
  EXPECT_EQ(simulation.ledger().countEmitted, 7000u);
  EXPECT_GT(simulation.ledger().countDied, 1000u);
  const ParticleView view = simulation.view();
  for (size_t n = 0; n < view.size(); ++n) {
    const float share = simulation.particles().age[n] / simulation.particles().life[n];
    ASSERT_LT(share, 1.0f);
    ASSERT_NEAR(view.radius[n], simulation.particles().radius[n] * (0.5f + 1.5f * share), 1e-6f);
    ASSERT_LE(view.mass[n], simulation.particles().mass[n]);
  }
}

TEST(Simulation, ManySmallStepsComeToWhatFewLargeOnesDo) {
  ParticleSystem system = busy();
  system.emitters.resize(1);
  system.emitters[0].rate.clear();
  system.emitters[0].bursts = {{0.0, 200.0}};
  system.emitters[0].life = 10.0;
  system.forces.neighbourReach = 0.0;
  system.forces.cohesion = system.forces.separation = 0.0;
  system.forces.ground = false;
  double errors[2];
  system.substeps = 64;
  Simulation fine = fresh(system);
  for (int n = 0; n < 24 * 64; ++n) fine.step();
  for (const int substeps : {2, 8}) {
    system.substeps = substeps;
    Simulation coarse = fresh(system);
    for (int n = 0; n < 24 * substeps; ++n) coarse.step();
    double sum = 0.0;
    for (size_t n = 0; n < 200; ++n)
      sum += std::hypot(double(coarse.particles().x[n] - fine.particles().x[n]),
                        double(coarse.particles().z[n] - fine.particles().z[n]));
    errors[substeps == 8] = sum / 200.0;
  }
  EXPECT_LT(errors[0], 0.1);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
}

TEST(Simulation, RefusesParticlesThatFlyAway) {
  ParticleSystem system = busy();
  system.emitters[0].velocity = {1e9, 0, 0};
  system.forces.drag = 0.0;
  system.forces.curlCellSize = 0.01;
  Simulation simulation = fresh(system);
  try {
    for (int n = 0; n < 48; ++n) simulation.step();
    ADD_FAILURE() << "accepted";
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("of emitter 0 came to ("), std::string::npos) << error.what();
  }
}

TEST(NeighbourGrid, FindsEveryPairWithinReachOnce) {
  std::vector<float> x, y, z;
  uint32_t state = 3;
  for (int n = 0; n < 1500; ++n) {
    x.push_back(4.0f * motion::nextUniform(state) - 2.0f);
    y.push_back(4.0f * motion::nextUniform(state) - 2.0f);
    z.push_back(4.0f * motion::nextUniform(state) - 2.0f);
  }
  const float reach = 0.3f;
  const NeighbourGrid grid(x, y, z, reach);
  const auto near = [&](size_t i, size_t j) {
    const float dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
    return dx * dx + dy * dy + dz * dz < reach * reach;
  };
  size_t pairs = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    std::vector<int> seen(x.size(), 0);
    grid.around(i, [&](size_t j) { ++seen[j]; });
    for (size_t j = 0; j < x.size(); ++j) {
      ASSERT_LE(seen[j], 1);
      if (j == i || !near(i, j)) continue;
      ASSERT_EQ(seen[j], 1);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 1000u);
}

}  // namespace
}  // namespace nephele
