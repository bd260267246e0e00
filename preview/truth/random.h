// Random numbers of the path tracer: a generator for each sample of each pixel, and stratified points for
// what a path draws first. Depends on nothing.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace nephele::truth {

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection of 64 bits without visible pattern.
inline uint64_t mixBits(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// One seed of several numbers, in order.
template <class... Parts>
uint64_t seedOf(Parts... parts) {
  uint64_t state = 0;
  ((state = mixBits(state + 0x9e3779b97f4a7c15u + static_cast<uint64_t>(parts))), ...);
  return state;
}

/// splitmix64: 2^64 numbers before it repeats. Cheap to make: every sample of a pixel has its own.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  /// In [0, 1), a multiple of 2^-24.
  float uniform() {
    state_ += 0x9e3779b97f4a7c15u;
    return static_cast<float>(mixBits(state_) >> 40) * 0x1p-24f;
  }
  /// Exponentially distributed with mean 1, at most 16.7.
  float exponential() { return -std::log(1.0f - uniform()); }

 private:
  uint64_t state_;
};

inline constexpr int kStratifiedDimensions = 7;

/// The columns of Sobol's generator matrices, by the primitive polynomials and initial numbers of Joe and Kuo
/// (2008).
constexpr std::array<std::array<uint32_t, 32>, kStratifiedDimensions> sobolColumns() {
  struct Start {
    int degree;
    unsigned polynomial;            // its inner coefficients
    std::array<uint32_t, 4> first;  // the initial numbers
  };
  constexpr std::array<Start, kStratifiedDimensions> kStarts{{{0, 0, {}},
                                                              {1, 0, {1}},
                                                              {2, 1, {1, 3}},
                                                              {3, 1, {1, 3, 1}},
                                                              {3, 2, {1, 1, 1}},
                                                              {4, 1, {1, 1, 3, 3}},
                                                              {4, 4, {1, 3, 5, 13}}}};
  std::array<std::array<uint32_t, 32>, kStratifiedDimensions> columns{};
  for (size_t d = 0; d < columns.size(); ++d) {
    const Start& start = kStarts[d];
    for (int i = 0; i < 32; ++i) {
      uint32_t& column = columns[d][static_cast<size_t>(i)];
      if (start.degree == 0)
        column = 1u << (31 - i);  // van der Corput
      else if (i < start.degree)
        column = start.first[static_cast<size_t>(i)] << (31 - i);
      else {
        const auto before = [&](int k) { return columns[d][static_cast<size_t>(i - k)]; };
        column = before(start.degree) ^ (before(start.degree) >> start.degree);
        for (int k = 1; k < start.degree; ++k)
          if ((start.polynomial >> (start.degree - 1 - k) & 1u) != 0) column ^= before(k);
      }
    }
  }
  return columns;
}

/// Point `number` of a block of stratified points, one dimension of it, in [0, 1): Sobol's sequence under an
/// Owen scrambling that follows from `seed` (Burley, "Practical hash-based Owen scrambling", 2020). Different
/// seeds are independent; under one seed the points of a block of 2^k fill every elementary interval evenly.
inline float stratified(int dimension, uint32_t number, uint64_t seed) {
  static constexpr auto kColumns = sobolColumns();
  uint32_t bits = 0;
  for (size_t i = 0; number != 0; number >>= 1, ++i)
    if ((number & 1u) != 0) bits ^= kColumns[static_cast<size_t>(dimension)][i];
  const auto reversed = [](uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
  };
  // Laine and Karras' hash: each bit is flipped by a hash of the bits below it, hence the reversals.
  uint32_t x = reversed(bits);
  const uint32_t scramble = static_cast<uint32_t>(seedOf(seed, dimension));
  x ^= x * 0x3d20adeau;
  x += scramble;
  x *= (scramble >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return static_cast<float>(reversed(x) >> 8) * 0x1p-24f;
}

}  // namespace nephele::truth
