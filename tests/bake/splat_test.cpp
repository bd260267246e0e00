// Splatting: mass at every size, kernels against closed forms, the same bits on threads and targets,
// refusals.
#include "bake/splat.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "bake/splat_kernels.h"
#include "tests/bake/every_target.h"
#include "tests/bake/particle_cloud.h"
#include "volume/bricks.h"

namespace nephele::test {
namespace {

TEST(Splat, KeepsMassFromATenthOfAVoxelToThirty) {
  for (const SplatKernel kernel : kKernels)
    for (const float radius : {0.1f, 0.5f, 0.99f, 1.0f, 1.01f, 1.1f, 1.5f, 2.0f, 3.3f, 8.0f, 17.0f, 30.0f}) {
      const Cloud cloud = randomCloud(radius > 10.0f ? 3 : 60, 40.0f, radius, radius);
      const SplatLedger ledger = splat(cloud.particles(), plain(kernel)).ledger;
      EXPECT_NEAR(ledger.stored / cloud.total(), 1.0, 1e-5) << int(kernel) << " radius " << radius;
      SplatSettings half = plain(kernel);
      half.half = true;
      EXPECT_NEAR(splat(cloud.particles(), half).ledger.stored / cloud.total(), 1.0, 1e-3)
          << int(kernel) << " radius " << radius;
    }
}

TEST(Splat, KeepsTheMassOfEachParticleAlone) {
  for (const SplatKernel kernel : kKernels)
    for (int n = 0; n < 200; ++n) {
      Cloud cloud = randomCloud(1, 100.0f, 0.1f, 12.0f, uint32_t(n) * 77u + 1u);
      ASSERT_NEAR(splat(cloud.particles(), plain(kernel)).ledger.stored / cloud.total(), 1.0, 1e-5)
          << int(kernel) << " radius " << cloud.radius[0];
    }
}

TEST(Splat, MassIsTheSameAtAnyVoxelSize) {
  const Cloud cloud = randomCloud(500, 3.0f, 0.05f, 0.6f);
  for (const double size : {0.02, 0.05, 0.11, 0.5}) {
    SplatSettings settings = plain();
    settings.voxelSize = size;
    EXPECT_NEAR(splat(cloud.particles(), settings).ledger.stored / cloud.total(), 1.0, 1e-5) << size;
  }
}

/// ∫ of a kernel of radius 1, and its second moment per axis, from its formula.
TEST(Splat, KernelsSumToTheirIntegrals) {
  const double pi = std::numbers::pi;
  // Wendland: 4π ∫ q² (1−q)⁴ (4q+1) = 4π · 1/42. Smooth sphere: numerically. Gaussian: (√(2π)/3 ·
  // erf(3/√2))³.
  double smooth = 0.0;
  constexpr int kSteps = 100000;
  for (int n = 0; n < kSteps; ++n) {
    const double q = (n + 0.5) / kSteps, s = std::clamp((1.0 - q * q) * 4.0 / 3.0, 0.0, 1.0);
    smooth += 4.0 * pi * q * q * s * s * (3.0 - 2.0 * s) / kSteps;
  }
  const double gaussian = std::pow(std::sqrt(2.0 * pi) / 3.0 * std::erf(3.0 / std::sqrt(2.0)), 3.0);
  const double expected[] = {gaussian, 4.0 * pi / 42.0, smooth};
  for (const SplatKernel kernel : kKernels) {
    const float radius = 30.0f;
    const SplatRecord record{{0, 0, 0}, {0.3f, 0.6f, 0.1f}, radius, 1.0f};
    double sum = 0.0;
    splatSums(kernel, &record, 1, &sum);
    const double cubed = double(radius) * double(radius) * double(radius);
    EXPECT_NEAR(sum / cubed / expected[int(kernel)], 1.0, 2e-3) << int(kernel);
  }
}

TEST(Splat, HoldsItsKernelAtEveryVoxel) {
  Cloud cloud;
  const glm::dvec3 at(3.25, -2.5, 9.875);
  cloud.add(glm::vec3(at), 5.5f, 7.0f);
  const BrickVolume bricks = stored(splat(cloud.particles(), plain(SplatKernel::wendland)));
  const auto kernel = [&](const glm::dvec3& p) {
    const double q = std::sqrt(glm::dot(p - at, p - at)) / 5.5, t = std::max(0.0, 1.0 - q);
    return t * t * t * t * (4.0 * q + 1.0);
  };
  double sum = 0.0;
  for (int x = -6; x <= 12; ++x)
    for (int y = -12; y <= 6; ++y)
      for (int z = 0; z <= 18; ++z) sum += kernel({x, y, z});
  for (int x = -6; x <= 12; ++x)
    for (int y = -12; y <= 6; ++y)
      for (int z = 0; z <= 18; ++z)
        ASSERT_NEAR(densityAt(bricks, {x, y, z}), 7.0 * kernel({x, y, z}) / sum, 1e-6)
            << x << ' ' << y << ' ' << z;
}

TEST(Splat, AParticleBelowAVoxelKeepsItsPlaceAndDoesNotFatten) {
  for (const float radius : {0.1f, 0.7f, 1.0f}) {
    Cloud cloud;
    cloud.add({4.25f, 7.5f, -3.1f}, radius, 2.0f);
    const Splatted splatted = splat(cloud.particles(), plain());
    EXPECT_EQ(splatted.voxelsActive, 8u);
    const BrickVolume bricks = stored(splatted);
    glm::dvec3 centre(0.0);
    for (int x = 4; x <= 5; ++x)
      for (int y = 7; y <= 8; ++y)
        for (int z = -4; z <= -3; ++z) centre += densityAt(bricks, {x, y, z}) / 2.0 * glm::dvec3(x, y, z);
    EXPECT_NEAR(centre.x, 4.25, 1e-5);
    EXPECT_NEAR(centre.y, 7.5, 1e-5);
    EXPECT_NEAR(centre.z, -3.1, 1e-5);
  }
}

TEST(Splat, LedgerAddsUp) {
  const Cloud cloud = randomCloud(3000, 30.0f, 0.5f, 6.0f);
  SplatSettings settings = plain(SplatKernel::gaussian);
  settings.cutoff = 0.02;
  settings.half = true;
  const SplatLedger l = splat(cloud.particles(), settings).ledger;
  EXPECT_NEAR(l.given, cloud.total(), 1e-9 * l.given);
  EXPECT_NEAR(l.splatted, l.given, 1e-5 * l.given);
  EXPECT_GT(l.lostToCutoff, 0.001 * l.given);
  EXPECT_NEAR(l.splatted, l.stored + l.lostToCutoff + l.lostToHalf, 1e-12 * l.given);
  settings.box = Box{glm::dvec3(-40.0, -40.0, -40.0), glm::dvec3(40.0, 40.0, 0.0)};
  const SplatLedger cut = splat(cloud.particles(), settings).ledger;
  EXPECT_NEAR(cut.given, cut.splatted + cut.outsideBox, 1e-12 * l.given);
  EXPECT_NEAR(cut.outsideBox / cut.given, 0.5, 0.1);
}

TEST(Splat, AStepRoundsDensitiesAndTheLedgerKnows) {
  const Cloud cloud = randomCloud(3000, 30.0f, 1.5f, 6.0f);
  SplatSettings settings = plain();
  const Splatted exact = splat(cloud.particles(), settings);
  settings.densityStep = 0x1p-10;
  const Splatted stepped = splat(cloud.particles(), settings);
  EXPECT_EQ(stepped.voxelsActive, exact.voxelsActive);
  const double levels = stepped.maximum / settings.densityStep;
  EXPECT_EQ(levels, std::round(levels));
  EXPECT_NEAR(stepped.maximum, exact.maximum, 0.5 * settings.densityStep);
  const SplatLedger l = stepped.ledger;
  EXPECT_NE(l.lostToHalf, 0.0);
  EXPECT_NEAR(l.splatted, l.stored + l.lostToCutoff + l.lostToHalf, 1e-12 * l.given);
}

TEST(Splat, ABoxIsTheActiveBoxOfEveryFrame) {
  SplatSettings settings = plain();
  settings.voxelSize = 0.5;
  settings.box = Box{glm::dvec3(-4.0, -3.0, -2.0), glm::dvec3(4.0, 5.0, 6.0)};
  for (const int count : {0, 1, 300}) {
    const Cloud cloud = randomCloud(count, 3.0f, 0.5f, 1.5f);
    const BrickVolume bricks = stored(splat(cloud.particles(), settings));
    EXPECT_EQ(bricks.activeMin, glm::ivec3(-8, -6, -4)) << count;
    EXPECT_EQ(bricks.activeMax, glm::ivec3(9, 11, 13)) << count;
  }
}

TEST(Splat, NoParticlesGiveAnEmptyGridThatIsAFile) {
  const Splatted empty = splat(Cloud{}.particles(), plain());
  EXPECT_EQ(empty.voxelsActive, 0u);
  const std::string path = (std::filesystem::temp_directory_path() / "nephele_splat_empty.vdb").string();
  EXPECT_GT(writeSplatted(path, empty, Provenance{}), 0u);
  std::filesystem::remove(path);
}

TEST(Splat, OtherGridsAreMeansWeightedByMass) {
  Cloud cloud;
  cloud.add({0.0f, 0.0f, 0.0f}, 3.0f, 1.0f, {1.0f, 0.0f, 0.0f});
  cloud.add({0.0f, 0.0f, 0.0f}, 3.0f, 3.0f, {0.0f, 2.0f, 0.0f});
  SplatSettings settings = plain();
  settings.vel = settings.temperature = settings.age = true;
  const std::string path = (std::filesystem::temp_directory_path() / "nephele_splat_grids.vdb").string();
  writeSplatted(path, splat(cloud.particles(), settings), Provenance{});
  const BrickVolume temperature = loadBricks(path, "temperature"), age = loadBricks(path, "age");
  std::filesystem::remove(path);
  // Temperatures 0 and 1 with masses 1 and 3.
  for (const glm::dvec3& at : {glm::dvec3(0.0), glm::dvec3(1.0, -1.0, 1.0)}) {
    EXPECT_NEAR(densityAt(temperature, at), 0.75, 1e-6);
    EXPECT_NEAR(densityAt(age, at), 0.25, 1e-6);
  }
}

SplatSettings everything() {
  SplatSettings settings = plain(SplatKernel::gaussian);
  settings.half = true;
  settings.cutoff = 1e-3;
  settings.vel = settings.temperature = settings.age = true;
  return settings;
}

TEST(Splat, IsTheSameOnAnyNumberOfThreads) {
  // More than a batch in one tile, and many tiles.
  Cloud cloud = randomCloud(40000, 20.0f, 0.3f, 4.0f);
  const Cloud wide = randomCloud(1500, 200.0f, 0.3f, 8.0f, 5);
  for (size_t n = 0; n < wide.x.size(); ++n)
    cloud.add({wide.x[n], wide.y[n], wide.z[n]}, wide.radius[n], wide.mass[n]);
  for (const SplatKernel kernel : kKernels)
    for (SplatSettings settings : {everything(), plain()}) {
      settings.kernel = kernel;
      std::string hashes[3];
      for (const int threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
        hashes[threads / 2] = contentHashOf(splat(cloud.particles(), settings));
      }
      EXPECT_EQ(hashes[0], hashes[1]);
      EXPECT_EQ(hashes[0], hashes[2]);
    }
}

TEST(Splat, IsTheSameOnEveryTarget) {
  const Cloud cloud = randomCloud(2000, 20.0f, 0.3f, 6.0f);
  expectEqualBitsOnEveryTarget([&] {
    std::vector<float> values;
    for (const SplatKernel kernel : kKernels)
      for (const double shutter : {0.0, 3.0})
        for (SplatSettings settings : {everything(), plain()}) {
          settings.kernel = kernel;
          settings.shutterSeconds = shutter;
          const std::string hash = contentHashOf(splat(cloud.particles(), settings));
          values.insert(values.end(), hash.begin(), hash.end());
        }
    return values;
  });
}

TEST(Splat, ManyPointsInOneVoxelLoseNoMass) {
  Cloud cloud;
  for (int n = 0; n < 400000; ++n) cloud.add({0.5f, 0.5f, 0.5f}, 0.2f, 1.0f);
  EXPECT_NEAR(splat(cloud.particles(), plain()).ledger.stored / cloud.total(), 1.0, 1e-6);
}

TEST(RoundToHalf, IsThatOfTheFile) {
  // Every half and the float midway to the next: ties to even.
  std::vector<float> values;
  for (uint32_t bits = 0; bits < 0x7bff; ++bits) {
    const auto valueOf = [](uint32_t h) {
      const int exponent = int(h >> 10), mantissa = int(h & 0x3ff);
      return float(exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25));
    };
    const float low = valueOf(bits), high = valueOf(bits + 1), middle = 0.5f * (low + high);
    float in[] = {low, middle, std::nextafterf(middle, 0.0f), std::nextafterf(middle, 1e9f), -middle};
    roundToHalf(in, 5);
    const float even = bits % 2 == 0 ? low : high;
    ASSERT_EQ(in[0], low) << bits;
    ASSERT_EQ(in[1], even) << bits;
    ASSERT_EQ(in[2], low) << bits;
    ASSERT_EQ(in[3], high) << bits;
    ASSERT_EQ(in[4], -even) << bits;
  }
}

void expectRefusal(const Cloud& cloud, const SplatSettings& settings, const std::string& sentence) {
  try {
    splat(cloud.particles(), settings);
    ADD_FAILURE() << "accepted; expected: " << sentence;
  } catch (const SplatError& error) {
    EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
  }
}

TEST(Splat, RefusesWhatCannotBeSplatted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto one = [](glm::vec3 p, float r, float m, glm::vec3 v = glm::vec3(0.0f)) {
    Cloud cloud = randomCloud(5000, 2.0f, 0.5f, 1.0f);
    cloud.add(p, r, m, v);
    return cloud;
  };
  expectRefusal(one({0.0f, nan, 0.0f}, 1.0f, 1.0f), plain(),
                "particle 5000 at (0, nan, 0) is not at a finite place");
  expectRefusal(one({1e30f, 0.0f, 0.0f}, 1.0f, 1.0f), plain(), "beyond voxel 2^30");
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 0.0f, 1.0f), plain(), "has the radius 0");
  expectRefusal(one({0.0f, 0.0f, 0.0f}, -1.0f, 1.0f), plain(), "has the radius -1");
  expectRefusal(one({0.0f, 0.0f, 0.0f}, nan, 1.0f), plain(), "has the radius nan");
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 2000.0f, 1.0f), plain(), "2e+03 voxels, more than");
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 1.0f, -1.0f), plain(), "has the mass -1");
  expectRefusal(one({1e6f, 1e6f, 1e6f}, 1.0f, 1.0f), plain(), "voxels");
  SplatSettings boxed = plain();
  boxed.voxelSize = 0.02;
  boxed.box = Box{glm::dvec3(-1.0, -1e9, -1.0), glm::dvec3(1.0, 1.0, 1.0)};
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 1.0f, 1.0f), boxed,
                "the frames' box reaches from -1e+09 to 1 along y, beyond voxel 2^30");
  SplatSettings half = plain();
  half.half = true;
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 1.5f, 1e6f), half, "more than half precision holds");
  SplatSettings blurred = plain();
  blurred.shutterSeconds = 1.0;
  expectRefusal(one({0.0f, 0.0f, 0.0f}, 1.0f, 1.0f, {1e5f, 0.0f, 0.0f}), blurred,
                "while the shutter is open");
}

}  // namespace
}  // namespace nephele::test
