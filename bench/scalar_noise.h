// Gradient noise as most programs have it: one point at a time, no SIMD. The peer that the engine is held
// against where no other library is at hand. Depends on nothing.
#pragma once

#include <cmath>
#include <cstdint>

namespace nephele::bench {

/// Fractal gradient noise in about [-1, 1]: Σ gain^i N(2^i p)/Σ gain^i, gain 0.5.
class ScalarFbm {
 public:
  ScalarFbm(float cellSize, int octaves) : frequency_(1.0f / cellSize), octaves_(octaves) {
    float total = 0.0f, weight = 1.0f;
    for (int i = 0; i < octaves; ++i, weight *= 0.5f) total += weight;
    scale_ = 1.0f / total;
  }

  float at(float x, float y, float z) const {
    x *= frequency_, y *= frequency_, z *= frequency_;
    float sum = 0.0f, weight = scale_;
    for (int i = 0; i < octaves_; ++i, weight *= 0.5f) {
      sum += weight * noise(x, y, z, uint32_t(i));
      x *= 2.0f, y *= 2.0f, z *= 2.0f;
    }
    return sum;
  }

 private:
  // The primes of the usual lattice hash, and its multiplier.
  static constexpr uint32_t kPrimeX = 501125321u, kPrimeY = 1136930381u, kPrimeZ = 1720413743u,
                            kMix = 0x27d4eb2du;
  static constexpr float kPerlinRange = 0.96492f;  // brings the noise to [-1, 1]

  static float corner(uint32_t x, uint32_t y, uint32_t z, uint32_t seed, float dx, float dy, float dz) {
    // The 12 edges of a cube, four of them twice.
    static constexpr float kEdges[16][4] = {{1, 1, 0, 0}, {-1, 1, 0, 0}, {1, -1, 0, 0}, {-1, -1, 0, 0},
                                            {1, 0, 1, 0}, {-1, 0, 1, 0}, {1, 0, -1, 0}, {-1, 0, -1, 0},
                                            {0, 1, 1, 0}, {0, -1, 1, 0}, {0, 1, -1, 0}, {0, -1, -1, 0},
                                            {1, 1, 0, 0}, {0, -1, 1, 0}, {-1, 1, 0, 0}, {0, -1, -1, 0}};
    const uint32_t hash = (seed ^ x ^ y ^ z) * kMix;
    const float* const edge = kEdges[(hash ^ (hash >> 15)) >> 3 & 15u];
    return edge[0] * dx + edge[1] * dy + edge[2] * dz;
  }

  static float fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }
  static float mix(float a, float b, float t) { return a + t * (b - a); }
  static int floorOf(float v) { return v >= 0.0f ? int(v) : int(v) - 1; }

  static float noise(float x, float y, float z, uint32_t seed) {
    const int ix = floorOf(x), iy = floorOf(y), iz = floorOf(z);
    const float x0 = x - float(ix), y0 = y - float(iy), z0 = z - float(iz);
    const float x1 = x0 - 1.0f, y1 = y0 - 1.0f, z1 = z0 - 1.0f;
    const float sx = fade(x0), sy = fade(y0), sz = fade(z0);
    const uint32_t cx0 = uint32_t(ix) * kPrimeX, cy0 = uint32_t(iy) * kPrimeY, cz0 = uint32_t(iz) * kPrimeZ;
    const uint32_t cx1 = cx0 + kPrimeX, cy1 = cy0 + kPrimeY, cz1 = cz0 + kPrimeZ;
    const float low =
        mix(mix(corner(cx0, cy0, cz0, seed, x0, y0, z0), corner(cx1, cy0, cz0, seed, x1, y0, z0), sx),
            mix(corner(cx0, cy1, cz0, seed, x0, y1, z0), corner(cx1, cy1, cz0, seed, x1, y1, z0), sx), sy);
    const float high =
        mix(mix(corner(cx0, cy0, cz1, seed, x0, y0, z1), corner(cx1, cy0, cz1, seed, x1, y0, z1), sx),
            mix(corner(cx0, cy1, cz1, seed, x0, y1, z1), corner(cx1, cy1, cz1, seed, x1, y1, z1), sx), sy);
    return mix(low, high, sz) * kPerlinRange;
  }

  float frequency_, scale_ = 1.0f;
  int octaves_;
};

}  // namespace nephele::bench
