// The grid of live particles against the bake's splat and against whole numbers, and the bricks that the
// march reads.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "bake/splat.h"
#include "preview/gpu/live_grid.h"
#include "preview/resolve.h"
#include "tests/preview/gl_bench.h"
#include "tests/scratch_folder.h"

namespace nephele::testing_gl {
namespace {

constexpr SimulationSettings kSettings{24.0, 2, 7};
constexpr LiveBox kBox{{-21, -9, 3}, {40, 33, 25}, 0.5};

/// Particles as slots hold them: at rest, of one age.
std::vector<LiveParticle> strewn(int count, float least, float most, float speed = 0.0f) {
  std::vector<LiveParticle> particles;
  uint32_t state = 5;
  const auto next = [&] { return motion::nextUniform(state); };
  for (int n = 0; n < count; ++n) {
    LiveParticle p{};
    const glm::vec3 share(next(), next(), next());
    p.place = glm::vec4((glm::vec3(kBox.low) - 1.0f + share * (glm::vec3(kBox.size) + 2.0f)) * 0.5f, 0.0f);
    p.motion = glm::vec4(speed * (2.0f * glm::vec3(next(), next(), next()) - 1.0f), 1.0f);
    p.born = {0.5f * least * std::pow(most / least, next()), 0.5f + next(), 0.0f, 0.0f};
    particles.push_back(p);
  }
  return particles;
}

double massOf(const std::vector<LiveParticle>& particles) {
  return std::accumulate(particles.begin(), particles.end(), 0.0,
                         [](double sum, const LiveParticle& p) { return sum + double{p.born.y}; });
}

ParticleSystem still(size_t count, SplatKernel kernel, double shutter) {
  ParticleSystem system;
  Emitter e;
  e.bursts = {{1.0, static_cast<double>(count)}};
  system.emitters = {e};
  system.kernel = kernel;
  system.shutter = shutter;
  return system;
}

/// The live grid of some particles, with all that it was made with.
struct Rebuilt {
  LiveMotion motion;
  BrickVolume volume;
  BrickAtlas atlas;
  LiveGrid grid;
  double mostMass, unit;

  Rebuilt(const std::vector<LiveParticle>& particles, SplatKernel kernel, double shutter = 0.0,
          const std::vector<TextChange>& changes = {})
      : motion(still(particles.size(), kernel, shutter), kSettings),
        volume(liveVolume(kBox, BrickVolume{})),
        atlas(volume, Filter::exact, Texel::r32f),
        grid(changes),
        mostMass(1.1 * massOf(particles)),
        unit(LiveGrid::unitOf(kBox, mostMass, motion.slotCount())) {
    motion.place(particles);
    grid.rebuild(motion, kBox, mostMass, atlas);
  }
  double density(const glm::ivec3& voxel, const std::vector<uint32_t>& sums) const {
    const glm::ivec3 at = voxel - kBox.low;
    return unit * sums[static_cast<size_t>((at.z * kBox.size.y + at.y) * kBox.size.x + at.x)];
  }
};

/// The bake's splat of the same particles, read back from its file.
BrickVolume bakedOf(const std::vector<LiveParticle>& particles, SplatKernel kernel, double shutter) {
  std::vector<float> columns[8];
  for (const LiveParticle& p : particles) {
    const float values[] = {p.place.x, p.place.y,  p.place.z,  p.born.x,
                            p.born.y,  p.motion.x, p.motion.y, p.motion.z};
    for (size_t n = 0; n < std::size(values); ++n) columns[n].push_back(values[n]);
  }
  const std::vector<float> none(particles.size(), 0.0f);
  const std::vector<uint32_t> ids(particles.size(), 0);
  SplatSettings settings;
  settings.voxelSize = kBox.voxelSize;
  settings.kernel = kernel;
  settings.cutoff = 0.0;
  settings.half = false;
  settings.shutterSeconds = shutter / kSettings.fps;
  const Splatted baked = splat({columns[0], columns[1], columns[2], columns[3], columns[4], columns[5],
                                columns[6], columns[7], none, none, ids},
                               settings);
  const ScratchFolder folder;
  writeSplatted(folder.file("baked.vdb"), baked, Provenance{});
  return loadBricks(folder.file("baked.vdb"));
}

struct GridError {
  double worst = 0.0, largest = 0.0;
};

GridError againstBake(const std::vector<LiveParticle>& particles, SplatKernel kernel, double shutter = 0.0,
                      const std::vector<TextChange>& changes = {}) {
  const Rebuilt live(particles, kernel, shutter, changes);
  const std::vector<uint32_t> sums = live.grid.readSums();
  const BrickVolume baked = bakedOf(particles, kernel, shutter);
  GridError error;
  for (int z = 0; z < kBox.size.z; ++z)
    for (int y = 0; y < kBox.size.y; ++y)
      for (int x = 0; x < kBox.size.x; ++x) {
        const glm::ivec3 voxel = kBox.low + glm::ivec3(x, y, z);
        const double expected = densityAt(baked, glm::dvec3(voxel));
        error.worst = std::max(error.worst, std::abs(live.density(voxel, sums) - expected));
        error.largest = std::max(error.largest, expected);
      }
  return error;
}

constexpr SplatKernel kKernels[] = {SplatKernel::gaussian, SplatKernel::wendland, SplatKernel::smoothSphere};
constexpr const char* kKernelNames[] = {"gaussian", "wendland", "smooth_sphere"};

TEST(GlLive, GridIsTheBakesAtEqualPlaces) {
  needContext();
  // Radii of a tenth to 5 voxels. A unit is 2e-8 of what there can be; places are floats of some ten voxels.
  const std::vector<LiveParticle> particles = strewn(400, 0.1f, 5.0f);
  for (const SplatKernel kernel : kKernels) {
    const GridError e = againstBake(particles, kernel);
    std::printf("%s: worst %.2e of %.3g\n", kKernelNames[static_cast<size_t>(kernel)], e.worst, e.largest);
    EXPECT_LT(e.worst, 2e-5 * e.largest);
  }
  EXPECT_GT(againstBake(particles, SplatKernel::wendland, 0.0,
                        {{"shared/splat.glsl", "(4.0f * q + 1.0f)", "(4.0f * q + 1.002f)"}})
                .worst,
            2e-5 * againstBake(particles, SplatKernel::wendland).largest);
}

TEST(GlLive, StretchedParticlesAreTheBakes) {
  needContext();
  const std::vector<LiveParticle> particles = strewn(150, 0.5f, 2.5f, 20.0f);
  for (const SplatKernel kernel : kKernels) {
    const GridError e = againstBake(particles, kernel, 0.5);
    std::printf("%s, stretched: worst %.2e of %.3g\n", kKernelNames[static_cast<size_t>(kernel)], e.worst,
                e.largest);
    EXPECT_LT(e.worst, 5e-5 * e.largest);
  }
}

TEST(GlLive, WideParticlesAreNormalisedByAnIntegral) {
  needContext();
  // Above 4096 voxels (a radius of 8) an integral stands for the sum over voxels; the Gaussian's sum is taken
  // along axes.
  const std::vector<LiveParticle> particles = strewn(12, 8.5f, 20.0f);
  const double within[] = {2e-5, 2e-5, 2e-4};
  for (const SplatKernel kernel : kKernels) {
    const GridError e = againstBake(particles, kernel);
    std::printf("%s, wide: worst %.2e of %.3g\n", kKernelNames[static_cast<size_t>(kernel)], e.worst,
                e.largest);
    EXPECT_LT(e.worst, within[static_cast<size_t>(kernel)] * e.largest);
  }
}

TEST(GlLive, MassIsWhole) {
  needContext();
  for (const float radius : {0.1f, 0.7f, 1.5f, 4.0f}) {
    // One at a time, so far inside that nothing reaches the border: the sum is the particle's mass in whole
    // units.
    std::vector<LiveParticle> particles = strewn(60, radius, radius);
    for (LiveParticle& p : particles)
      p.place = glm::vec4(0.5f * (glm::vec3(kBox.low) + 10.0f) + 0.05f * glm::vec3(p.place), 0.0f);
    for (const SplatKernel kernel : kKernels) {
      const Rebuilt live(particles, kernel);
      const std::vector<uint32_t> sums = live.grid.readSums();
      const double total = std::accumulate(sums.begin(), sums.end(), 0.0);
      const double volume = kBox.voxelSize * kBox.voxelSize * kBox.voxelSize;
      // A float holds a particle's units to 2^-24 of them, and running sums of a hundred shares to a few
      // times that.
      EXPECT_NEAR(total * live.unit * volume, massOf(particles), 2e-6 * massOf(particles)) << radius;
    }
  }
}

TEST(GlLive, OrderDoesNotMatter) {
  needContext();
  std::vector<LiveParticle> particles = strewn(3000, 0.5f, 3.0f);
  const Rebuilt one(particles, SplatKernel::wendland);
  std::reverse(particles.begin(), particles.end());
  const Rebuilt other(particles, SplatKernel::wendland);
  // The mass bound is a sum too: the same doubles in another order, so the same to rounding, and equal
  // floats.
  ASSERT_EQ(static_cast<float>(one.unit), static_cast<float>(other.unit));
  EXPECT_EQ(one.grid.readSums(), other.grid.readSums());
}

TEST(GlLive, TheMarchReadsWhatWasResolved) {
  needContext();
  const std::vector<LiveParticle> particles = strewn(500, 1.0f, 4.0f);
  const Rebuilt live(particles, SplatKernel::wendland);
  // The same densities as a volume that was read: pictures must be alike to the last bits of a sum.
  const std::vector<uint32_t> sums = live.grid.readSums();
  const float unit = static_cast<float>(live.unit);
  std::vector<float> dense;
  for (const uint32_t sum : sums) dense.push_back(static_cast<float>(sum) * unit);
  BrickVolume read = bricksFromDense(dense, kBox.size, kBox.low, live.volume.worldFromIndex);
  read.activeMin = live.volume.activeMin;
  read.activeMax = live.volume.activeMax;
  read.meanActive =
      live.volume.meanActive;  // of the file that is played live: how the light cache is laid out
  ViewedScene view;
  view.camera = frameCamera(read, {0.0, 0.0, 1.0}, 0.6, 1.5);
  view.medium.sigmaS = {0.2, 0.3, 0.4};
  view.scene.lights = {Sun{}};
  view.scene.march.adaptive = false;
  constexpr int kWidth = 60, kHeight = 40;
  MarchPass pass(Filter::exact);
  const auto picture = [&](const BrickVolume& volume, const BrickAtlas& atlas) {
    pass.setParameters(marchParameters(view, volume, kWidth, kHeight, 1, false));
    const Film film(kWidth, kHeight);
    pass.draw(atlas, film, {0.5f, 0.5f}, 0, {0, 0, kWidth, kHeight});
    return film.read().picture;
  };
  const Picture ours = picture(live.volume, live.atlas),
                theirs = picture(read, BrickAtlas(read, Filter::exact, Texel::r32f));
  double worst = 0.0, brightest = 0.0;
  for (size_t plane = 0; plane < ours.planes.size(); ++plane)
    for (size_t n = 0; n < ours.planes[plane].size(); ++n) {
      worst = std::max(worst, std::abs(double{ours.planes[plane][n]} - double{theirs.planes[plane][n]}));
      brightest = std::max(brightest, double{theirs.planes[plane][n]});
    }
  std::printf("live picture against the one of a volume read: worst %.2e of %.3g\n", worst, brightest);
  EXPECT_GT(brightest, 0.1);
  EXPECT_LT(worst, 1e-4 * brightest);
  // Long steps trust the index's bounds: with bounds that are too low they would leave out most of what is
  // thick.
  view.scene.march.adaptive = true;
  const Picture adaptive = picture(live.volume, live.atlas);
  double squares = 0.0, sum = 0.0;
  for (size_t n = 0; n < ours.planes[0].size(); ++n) {
    squares += std::pow(double{adaptive.planes[0][n]} - double{ours.planes[0][n]}, 2.0);
    sum += double{ours.planes[0][n]};
  }
  const double rmse = std::sqrt(squares / static_cast<double>(ours.planes[0].size())) *
                      static_cast<double>(ours.planes[0].size()) / sum;
  std::printf("adaptive against even steps: relative RMSE %.2e\n", rmse);
  EXPECT_LT(rmse, 0.02);
}

}  // namespace
}  // namespace nephele::testing_gl
