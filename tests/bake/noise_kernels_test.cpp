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

/// The definition at points whose place in the lattice is computed in floats, as at points.
float byFloatPlaces(const NoiseOctave& octave, const Points& points, size_t n) {
  const auto at = [&](double origin, float by, int32_t& cell) {
    const CellPlace first = cellPlace(origin, octave.cellSize);
    const float place = first.fraction + by * float(1.0 / octave.cellSize), whole = std::floor(place);
    cell = cellAfter(first.cell, whole);
    return place - whole;
  };
  glm::ivec3 cell;
  const float x = at(points.origin.x, points.x[n], cell.x), y = at(points.origin.y, points.y[n], cell.y),
              z = at(points.origin.z, points.z[n], cell.z);
  return octave.weight * noiseInCell(octave, cell, {x, y, z});
}

TEST(NoiseKernels, AgreeWithTheDefinition) {
  float largest = 0.0f;
  for (const KernelCase& c : cases()) {
    float block[kBlockPoints] = {}, points[kBlockPoints] = {};
    addNoiseOnLattice(&c.octave, 1, c.lattice, block);
    addNoiseAtPoints(&c.octave, 1, LatticePoints(c.lattice).points(), points);
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
      addNoiseAtPoints(&all[n].octave, 1, LatticePoints(all[n].lattice).points(),
                       &values[(n * 2 + 1) * kBlockPoints]);
    }
    return values;
  });
}

/// 500 points strewn over `reach` cells, all of them in whole vectors but for the last few.
struct Strewn {
  std::vector<float> x, y, z;
  Points points() const { return {{12.5, -7.25, 3.0}, x.size(), x.data(), y.data(), z.data()}; }
};
Strewn strewnOver(double reach, std::mt19937& random) {
  std::uniform_real_distribution<float> place(float(-0.5 * reach), float(0.5 * reach));
  Strewn strewn;
  constexpr int kPoints = 500;
  for (int n = 0; n < kPoints; ++n) {
    strewn.x.push_back(place(random));
    strewn.y.push_back(place(random));
    strewn.z.push_back(place(random));
  }
  return strewn;
}

TEST(NoiseKernels, PointsThatReachOverFewOrManyCellsAgreeWithTheDefinition) {
  const auto values = [] {
    std::mt19937 random(11);
    std::vector<float> all;
    float largest = 0.0f;
    // Within a cell, over a few, over up to 16 and over many more; with a period and turned.
    for (const double reach : {0.3, 1.1, 2.5, 7.0, 14.5, 15.9, 17.0, 40.0, 1e5})
      for (const int period : {0, 5})
        for (const bool turns : {false, true}) {
          NoiseOctave octave{1.0, 0.6f, 77u, period};
          if (turns) octave.turn = turnAt(0.37);
          const Strewn strewn = strewnOver(reach, random);
          const Points points = strewn.points();
          std::vector<float> sums(points.count, 0.0f);
          addNoiseAtPoints(&octave, 1, points, sums.data());
          for (size_t n = 0; n < points.count; ++n)
            largest = std::max(largest, std::abs(sums[n] - byFloatPlaces(octave, points, n)));
          all.insert(all.end(), sums.begin(), sums.end());
        }
    EXPECT_LE(largest, 1e-6f);
    return all;
  };
  expectEqualBitsOnEveryTarget(values);
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
