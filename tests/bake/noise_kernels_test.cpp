// The SIMD kernels against the definition in the shared text, and against each other: every target must give
// equal bits.
#include "bake/fields/noise_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/fields/cell_place.h"
#include "bake/fields/shared_text.h"
#include "tests/bake/every_target.h"

namespace nephele::test {
namespace {

/// Octaves and blocks of all kinds: cells from 2 to 1000 voxels, with and without period, at rest and turned,
/// near and far from the origin.
struct KernelCase {
  NoiseOctave octave;
  Lattice lattice;
};
std::vector<KernelCase> cases() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-100.0, 100.0), exponent(std::log(2.0), std::log(1000.0));
  std::vector<KernelCase> list;
  for (int n = 0; n < 400; ++n) {
    const double cell = std::exp(exponent(random));
    const double far = n % 7 == 0 ? 1e6 : 0.0;
    NoiseOctave octave{cell, 0.7f, uint32_t(random()), n % 5 == 0 ? 3 : 0};
    if (n % 3 == 0) octave.turn = turnAt(0.0123 * n);
    list.push_back({octave, {{place(random) + far, place(random) - far, place(random)}, 1.0}});
  }
  // Blocks that start on a cell's corner, and cells of exactly two voxels.
  list.push_back({{2.0, 1.0f, 1u, 0}, {{0.0, 8.0, -8.0}, 1.0}});
  list.push_back({{8.0, 1.0f, 1u, 0}, {{-8.0, 16.0, 0.0}, 1.0}});
  return list;
}

/// The definition, with each place computed in double.
float byDefinition(const NoiseOctave& octave, const glm::dvec3& p) {
  const CellPlace x = cellPlace(p.x, octave.cellSize), y = cellPlace(p.y, octave.cellSize),
                  z = cellPlace(p.z, octave.cellSize);
  return octave.weight * noiseInCell(octave, {x.cell, y.cell, z.cell}, {x.fraction, y.fraction, z.fraction});
}

TEST(NoiseKernels, AgreeWithTheDefinition) {
  float largest = 0.0f;
  for (const KernelCase& c : cases()) {
    float block[kBlockPoints] = {}, points[kBlockPoints] = {};
    addNoiseOnLattice(&c.octave, 1, c.lattice, block);
    addNoiseAtPoints(c.octave, LatticePoints(c.lattice).points(), points);
    for (int n = 0; n < kBlockPoints; ++n) {
      const glm::dvec3 p = c.lattice.origin + c.lattice.spacing * glm::dvec3(n / 64, n / 8 % 8, n % 8);
      const float exact = byDefinition(c.octave, p);
      largest = std::max({largest, std::abs(block[n] - exact), std::abs(points[n] - exact)});
    }
  }
  EXPECT_LE(largest, 4e-6f);
}

TEST(NoiseKernels, EveryTargetGivesEqualBits) {
  const auto all = cases();
  expectEqualBitsOnEveryTarget([&] {
    std::vector<float> values(all.size() * kBlockPoints * 2, 0.25f);
    for (size_t n = 0; n < all.size(); ++n) {
      addNoiseOnLattice(&all[n].octave, 1, all[n].lattice, &values[n * 2 * kBlockPoints]);
      addNoiseAtPoints(all[n].octave, LatticePoints(all[n].lattice).points(),
                       &values[(n * 2 + 1) * kBlockPoints]);
    }
    return values;
  });
}

TEST(NoiseKernels, CellsSmallerThanTwoVoxelsAreLegal) {
  const NoiseOctave octave{1.3, 1.0f, 4u, 0};
  const Lattice lattice{{0.4, 0.1, 0.7}, 1.0};
  float block[kBlockPoints] = {};
  addNoiseOnLattice(&octave, 1, lattice, block);
  for (int n = 0; n < kBlockPoints; ++n)
    ASSERT_NEAR(block[n], byDefinition(octave, lattice.origin + glm::dvec3(n / 64, n / 8 % 8, n % 8)), 1e-5f);
}

}  // namespace
}  // namespace nephele::test
