// Particle systems as YAML: both ways, and what is refused.
#include <gtest/gtest.h>

#include "particles/particles.h"

namespace nephele {
namespace {

ParticleSystem read(const std::string& text) {
  Diagnostics out;
  ParticleSystem system = readParticles(*yaml::parse(text, "p.yaml"), out);
  out.throwIfAny();
  return system;
}

void expectRefusal(const std::string& text, const std::string& sentence) {
  try {
    read(text);
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  }
}

constexpr const char* kFull = R"(
emitters:
  - { shape: disc, center: [0, 0, 1], radius: 0.2, axis: [0, 1, 1], rate: [[0, 100], [2, 0]], velocity: [0, 0, 2],
      spread: 0.3, particle_radius: 0.05, radius_variation: 0.5, density: 2, life: 3, life_variation: 0.2, temperature: 1 }
  - { shape: points, file: "a b.csv", scale: 2 }
forces:
  gravity: [0, 0, -9.81]
  drag: 1.5
  curl_noise: { speed: 0.4, cell_size: 0.3, octaves: 3 }
  neighbours: { radius: 0.1, cohesion: 2, separation: 3 }
  ground: {}
  vortices: [{ center: [0, 0, 1], rate: 4 }]
  attractors: [{ strength: -1 }, { strength: 2, radius: 0.5 }]
size_over_life: [[0, 0.5], [1, 2.5]]
density_over_life: [[0.5, 1], [1, 0.1]]
substeps: 4
kernel: gaussian
shutter: 0.5
erosion: { amount: 0.4, field: { fbm: { cell_size: 0.5 } } }
grids: [vel, age]
write_points: [csv]
box: { min: [-1, -1, 0], max: [1, 1, 3] }
)";

TEST(ParticlesYaml, WritesWhatItReads) {
  const ParticleSystem system = read(kFull);
  EXPECT_EQ(system.emitters.size(), 2u);
  EXPECT_EQ(system.emitters[0].shape, EmitterShape::disc);
  EXPECT_EQ(system.emitters[1].file, "a b.csv");
  EXPECT_TRUE(system.forces.ground);
  EXPECT_EQ(system.forces.attractors[1].radius, 0.5);
  EXPECT_EQ(system.kernel, SplatKernel::gaussian);
  const std::string written = writeParticles(system);
  const ParticleSystem again = read(written);
  EXPECT_EQ(writeParticles(again), written);
  EXPECT_EQ(again.forces.curlCellSize, 0.3);
  EXPECT_EQ(again.sizeOverLife, system.sizeOverLife);
  EXPECT_EQ(again.emitters[0].axis, system.emitters[0].axis);
  EXPECT_TRUE(again.erosionField != nullptr);
  EXPECT_EQ(again.grids, system.grids);
  EXPECT_EQ(again.boxMax, system.boxMax);
  const ParticleSystem plain = read("emitters: [{ rate: 5 }]");
  EXPECT_FALSE(plain.forces.ground);
  EXPECT_EQ(writeParticles(plain), "emitters: [{ rate: [[0, 5]] }]\n");
}

TEST(ParticlesYaml, RefusesWhatIsWrong) {
  expectRefusal("{}", "at least one of 'emitters'");
  expectRefusal("emitters: [{}]", "needs 'rate' or 'bursts'");
  expectRefusal("emitters: [{ rate: 5, particle_radius: 0 }]", "'particle_radius' must be greater than 0");
  expectRefusal("emitters: [{ rate: 5, particle_radius: -1 }]", "'particle_radius' must be greater than 0");
  expectRefusal("emitters: [{ rate: 5, life: 0 }]", "'life' must be greater than 0");
  expectRefusal("emitters: [{ rate: 5, center: [0, .nan, 0] }]", "'center'");
  expectRefusal("emitters: [{ rate: 5, center: [0, 1e30, 0] }]", "'center'");
  expectRefusal("emitters: [{ rate: 1e9, life: 1 }]", "take 96 GB");
  expectRefusal("emitters: [{ bursts: [[0, 1e9]] }]", "too many");
  expectRefusal("emitters: [{ shape: mesh, rate: 5 }]", "needs 'file'");
  expectRefusal("emitters: [{ shape: sphere, rate: 5, file: a }]", "only the shapes mesh and points");
  expectRefusal("emitters: [{ shape: sphre, rate: 5 }]", "did you mean 'sphere'?");
  expectRefusal("emitters: [{ rate: [[1, 5], [1, 6]] }]", "growing x");
  expectRefusal("emitters: [{ rate: 5 }]\nkernal: gaussian", "did you mean 'kernel'?");
  expectRefusal("emitters: [{ rate: 5 }]\ngrids: [vell]", "did you mean 'vel'?");
  expectRefusal("emitters: [{ rate: 5 }]\nforces: { neighbours: { cohesion: 1 } }",
                "need the neighbours' 'radius'");
  expectRefusal("emitters: [{ rate: 5, axis: [0, 0, 0] }]", "must have a length");
  expectRefusal("emitters: [{ rate: 5 }]\nbox: { min: [0, 0, 0], max: [1, 0, 1] }", "must lie below");
  expectRefusal("emitters: [{ rate: 5 }]\nstable_box: true\nbox: { min: [0, 0, 0], max: [1, 1, 1] }",
                "leave one of the two out");
}

TEST(ParticlesYaml, BirthsAreTheIntegralOfTheRate) {
  Emitter e;
  e.rate = {{0.0, 100.0}, {2.0, 0.0}};
  // 100 t − 25 t² up to 2, and nothing after.
  EXPECT_EQ(bornUntil(e, 0.0), 0u);
  EXPECT_EQ(bornUntil(e, 1.0), 75u);
  EXPECT_EQ(bornUntil(e, 2.0), 100u);
  EXPECT_EQ(bornUntil(e, 9.0), 100u);
  e.bursts = {{0.0, 7.0}, {3.0, 5.0}};
  EXPECT_EQ(bornUntil(e, 0.0), 7u);
  EXPECT_EQ(bornUntil(e, 3.0), 112u);
}

}  // namespace
}  // namespace nephele
