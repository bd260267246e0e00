// The power spectrum of gradient noise over six periodic cubes of 8 cells, against its closed form. Noise
// is Σ g · K(p − c) over lattice points c, K(d) = d w(dx) w(dy) w(dz), w(t) = 1 − fade(|t|); with independent
// gradients the expected power at a frequency k is Σ_i E[g_i²] |K̂_i(k)|².
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "bake/fields/shared_text.h"

namespace nephele::test {
namespace {

constexpr int kCells = 8, kPerCell = 8, kEdge = kCells * kPerCell;  // samples along an axis
constexpr uint32_t kCubes = 6;
using Complex = std::complex<double>;

size_t indexOf(int x, int y, int z) { return (size_t(z) * kEdge + size_t(y)) * kEdge + size_t(x); }

/// Fourier transform of kEdge numbers at a stride, in place [Cooley and Tukey 1965].
void transform(Complex* data, size_t stride) {
  std::array<Complex, kEdge> line;
  for (size_t n = 0; n < kEdge; ++n) {
    size_t reversed = 0;
    for (size_t bit = 1; bit < kEdge; bit *= 2) reversed = reversed * 2 + (n / bit) % 2;
    line[reversed] = data[n * stride];
  }
  for (size_t half = 1; half < kEdge; half *= 2)
    for (size_t k = 0; k < half; ++k) {
      const Complex turn = std::polar(1.0, -std::numbers::pi * double(k) / double(half));
      for (size_t n = k; n < kEdge; n += 2 * half) {
        const Complex odd = turn * line[n + half];
        line[n + half] = line[n] - odd;
        line[n] += odd;
      }
    }
  for (size_t n = 0; n < kEdge; ++n) data[n * stride] = line[n];
}

/// Power of each frequency, divided so that its sum is the mean square.
std::vector<double> powerOf(uint32_t seed) {
  std::vector<Complex> cube(size_t(kEdge) * kEdge * kEdge);
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x)
        cube[indexOf(x, y, z)] = double(shared::perlinNoise(
            {x / kPerCell, y / kPerCell, z / kPerCell},
            glm::vec3(x % kPerCell, y % kPerCell, z % kPerCell) / float(kPerCell), kCells, seed));
  const auto along = [&](size_t stride, const auto& start) {
    for (int a = 0; a < kEdge; ++a)
      for (int b = 0; b < kEdge; ++b) transform(&cube[start(a, b)], stride);
  };
  along(indexOf(1, 0, 0), [](int a, int b) { return indexOf(0, a, b); });
  along(indexOf(0, 1, 0), [](int a, int b) { return indexOf(a, 0, b); });
  along(indexOf(0, 0, 1), [](int a, int b) { return indexOf(a, b, 0); });
  std::vector<double> power;
  for (const Complex& c : cube) power.push_back(std::norm(c) / (double(cube.size()) * double(cube.size())));
  return power;
}

/// Expected power at each frequency. Along one axis the transform of w is real, that of t w imaginary; of the
/// 16 gradients 10 have a part along x, 12 along y, 10 along z.
std::vector<double> expectedPower() {
  std::array<double, kEdge> even{}, odd{};
  for (int k = 0; k < kEdge; ++k)
    for (int n = -kPerCell; n <= kPerCell; ++n) {
      const double t = double(n) / kPerCell, a = std::abs(t);
      const double w = 1.0 - a * a * a * (a * (6.0 * a - 15.0) + 10.0);
      const double angle = 2.0 * std::numbers::pi * double(k) * double(n) / kEdge;
      even[size_t(k)] += w * std::cos(angle) / kEdge;
      odd[size_t(k)] += t * w * std::sin(angle) / kEdge;
    }
  const double corners = kCells * kCells * kCells, scale = double(shared::kPerlinScale);
  std::vector<double> power(size_t(kEdge) * kEdge * kEdge);
  const auto square = [](double v) { return v * v; };
  for (size_t z = 0; z < kEdge; ++z)
    for (size_t y = 0; y < kEdge; ++y)
      for (size_t x = 0; x < kEdge; ++x)
        power[indexOf(int(x), int(y), int(z))] = corners * scale * scale *
                                                 (10.0 / 16.0 * square(odd[x] * even[y] * even[z]) +
                                                  12.0 / 16.0 * square(even[x] * odd[y] * even[z]) +
                                                  10.0 / 16.0 * square(even[x] * even[y] * odd[z]));
  return power;
}

/// Mean over the cubes.
const std::vector<double>& measuredPower() {
  static const std::vector<double> mean = [] {
    std::vector<double> sum(size_t(kEdge) * kEdge * kEdge);
    for (uint32_t seed = 1; seed <= kCubes; ++seed) {
      const std::vector<double> power = powerOf(seed);
      for (size_t n = 0; n < sum.size(); ++n) sum[n] += power[n] / kCubes;
    }
    return sum;
  }();
  return mean;
}

/// Sum of the power at frequencies that `choose(k)` takes, k in waves per cell.
template <class Choose>
double sumOf(const std::vector<double>& power, const Choose& choose) {
  double sum = 0.0;
  const auto frequency = [](int n) { return double(n < kEdge / 2 ? n : n - kEdge) / kCells; };
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x)
        if (choose(glm::dvec3(frequency(x), frequency(y), frequency(z)))) sum += power[indexOf(x, y, z)];
  return sum;
}

double lengthOf(const glm::dvec3& k) { return std::sqrt(k.x * k.x + k.y * k.y + k.z * k.z); }
constexpr auto kAll = [](const glm::dvec3&) { return true; };

TEST(PerlinSpectrum, HoldsNoConstantPart) {
  // Each corner's part is odd about the corner: a period's mean is 0 but for rounding.
  for (uint32_t seed = 1; seed <= kCubes; ++seed) EXPECT_LT(std::sqrt(powerOf(seed)[0]), 1e-7);
}

TEST(PerlinSpectrum, IsThatOfIndependentGradients) {
  const std::vector<double>&measured = measuredPower(), expected = expectedPower();
  const double all = sumOf(expected, kAll);
  // The mean square of 3072 gradients errs by some 2%.
  EXPECT_NEAR(sumOf(measured, kAll) / all, 1.0, 0.08);
  const std::vector<double> ones(expected.size(), 1.0);
  for (int shell = 1; shell < 16; ++shell) {
    const auto inShell = [&](const glm::dvec3& k) {
      return lengthOf(k) * kCells >= double(shell) && lengthOf(k) * kCells < double(shell) + 1.0;
    };
    // A frequency and its opposite hold one complex number, whose power errs by its own size: four standard
    // errors of the mean over the shell and the cubes.
    const double share = sumOf(expected, inShell) / all, frequencies = sumOf(ones, inShell);
    EXPECT_NEAR(sumOf(measured, inShell) / all, share, 4.0 * share * std::sqrt(2.0 / (frequencies * kCubes)))
        << "shell " << shell;
  }
}

TEST(PerlinSpectrum, LiesInOneOctaveAndABit) {
  const std::vector<double>& measured = measuredPower();
  const double all = sumOf(measured, kAll);
  const auto share = [&](double low, double high) {
    return sumOf(measured, [&](const glm::dvec3& k) { return low <= lengthOf(k) && lengthOf(k) < high; }) /
           all;
  };
  // By the closed form 0.746 lies between half a wave and one wave a cell.
  EXPECT_GT(share(0.5, 1.0), 0.70);
  EXPECT_GT(share(0.25, 1.0), 0.90);
  EXPECT_LT(share(0.0, 0.25), 0.015);
  EXPECT_LT(share(2.0, 99.0), 0.001);
}

TEST(PerlinSpectrum, FavoursNoAxisByMuch) {
  // Within 26 degrees of each axis. By the closed form y has 1.18 times the power of x and z, since 12 of the
  // 16 gradients have a part along it and 10 along each of the others.
  const std::vector<double>&measured = measuredPower(), expected = expectedPower();
  double least = 1.0, most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto near = [&](const glm::dvec3& k) {
      return lengthOf(k) > 0.0 && std::abs(k[axis]) > 0.9 * lengthOf(k);
    };
    const double share = sumOf(measured, near) / sumOf(measured, kAll),
                 declared = sumOf(expected, near) / sumOf(expected, kAll);
    EXPECT_NEAR(share / declared, 1.0, 0.15) << "axis " << axis;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  EXPECT_LT(most / least, 1.35);
}

}  // namespace
}  // namespace nephele::test
