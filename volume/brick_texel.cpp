// Halves, 8-bit samples and their errors. Depends on volume/brick_bounds.h and TBB.
#include "volume/brick_texel.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "volume/brick_bounds.h"

namespace nephele {
namespace {

constexpr int kHalfMantissa = 10, kFloatMantissa = 23, kDropped = kFloatMantissa - kHalfMantissa;
constexpr uint32_t kRebias = (127u - 15u)
                             << kHalfMantissa;  // between the exponents' offsets, in a half's places
constexpr uint32_t kHalfInfinity = 31u << kHalfMantissa;
constexpr float kLeastNormalHalf = 6.103515625e-5f;       // 2^-14
constexpr float kSubnormalStep = 5.9604644775390625e-8f;  // 2^-24
constexpr float kByte = 255.0f;

/// Worst error of a slot's samples, its relative part and the rest, and the sum of those at the lower 8 of
/// each axis.
struct SlotFacts {
  double error = 0.0, relative = 0.0, sum = 0.0;
};

template <Texel texel>
SlotFacts factsOf(const float* samples, float maximum) {
  const float scale = brick_bounds::bound(
      brick_bounds::codeFor(*std::max_element(samples, samples + kBrickVolume), maximum), maximum);
  // Of a half's normal values; what goes beyond it is counted as it is.
  constexpr double kHalfRelative = 0x1p-11, kTiny = 1e-300;
  constexpr double allowed = texel == Texel::r16f ? kHalfRelative : 0.0;
  SlotFacts facts;
  for (int z = 0; z < kBrickSamples; ++z)
    for (int y = 0; y < kBrickSamples; ++y)
      for (int x = 0; x < kBrickSamples; ++x, ++samples) {
        const double value = double{*samples};
        if (std::max({x, y, z}) < kBrickCells) facts.sum += value;
        const double error = std::abs(double{keptAs(texel, *samples, scale)} - value);
        if (!(error > 0.0)) continue;  // most samples of a file of halves
        facts.relative = std::max(facts.relative, std::min(error, allowed * value) / std::max(value, kTiny));
        facts.error = std::max(facts.error, error - allowed * value);
      }
  return facts;
}

/// The longest way through a layer of cells of thickness 1 and extent 1, world units.
double longestWay(const glm::dmat4& worldFromIndex) {
  double most = 0.0;
  for (const glm::dvec3& way : {glm::dvec3(1, 1, 1), {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}}) {
    const glm::dvec4 world = worldFromIndex * glm::dvec4(way, 0.0);
    most = std::max(most, std::sqrt(world.x * world.x + world.y * world.y + world.z * world.z));
  }
  return most;
}

}  // namespace

size_t bytesOf(Texel texel) {
  return texel == Texel::r8 ? sizeof(uint8_t) : texel == Texel::r16f ? sizeof(uint16_t) : sizeof(float);
}

std::string_view nameOf(Texel texel) {
  return texel == Texel::r8 ? "r8" : texel == Texel::r16f ? "r16f" : "r32f";
}

uint16_t halfOf(float value) {
  // Below the least normal half, even steps; nearbyint rounds ties to even.
  if (value < kLeastNormalHalf) return static_cast<uint16_t>(std::nearbyint(value / kSubnormalStep));
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const uint32_t odd = bits >> kDropped & 1u;
  const uint32_t half = ((bits + (1u << (kDropped - 1)) - 1u + odd) >> kDropped) - kRebias;
  return static_cast<uint16_t>(std::min(half, kHalfInfinity));
}

float fromHalf(uint16_t half) {
  if (half < 1u << kHalfMantissa) return static_cast<float>(half) * kSubnormalStep;
  if (half >= kHalfInfinity) return std::numeric_limits<float>::infinity();
  return std::bit_cast<float>((uint32_t{half} + kRebias) << kDropped);
}

uint8_t byteOf(float value, float scale) {
  return scale > 0.0f ? static_cast<uint8_t>(value / scale * kByte + 0.5f) : uint8_t{0};
}

float keptAs(Texel texel, float value, float scale) {
  switch (texel) {
    case Texel::r8:
      return static_cast<float>(byteOf(value, scale)) * (1.0f / kByte) * scale;
    case Texel::r16f:
      return fromHalf(halfOf(value));
    case Texel::r32f:
      return value;
  }
  return value;
}

double texelError(const BrickVolume& volume, Texel texel) {
  if (texel == Texel::r32f || volume.empty()) return 0.0;
  std::vector<SlotFacts> facts(volume.slotCount());
  tbb::parallel_for(size_t{0}, facts.size(), [&](size_t slot) {
    const float* samples = volume.samples.data() + slot * kBrickVolume;
    const float maximum = static_cast<float>(volume.maximum);
    facts[slot] =
        texel == Texel::r8 ? factsOf<Texel::r8>(samples, maximum) : factsOf<Texel::r16f>(samples, maximum);
  });
  const glm::ivec3 n = volume.brickCount;
  double worst = 0.0, deepest = 0.0, relative = 0.0;
  for (const SlotFacts& slot : facts) relative = std::max(relative, slot.relative);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<double> layers(static_cast<size_t>(n[axis]), 0.0);
    std::vector<double> columns(static_cast<size_t>(n[u]) * static_cast<size_t>(n[v]), 0.0);
    size_t i = 0;
    for (glm::ivec3 b(0); b.z < n.z; ++b.z)
      for (b.y = 0; b.y < n.y; ++b.y)
        for (b.x = 0; b.x < n.x; ++b.x, ++i) {
          if (volume.index[i] == 0) continue;
          const SlotFacts& slot = facts[volume.index[i] - 1];
          double& layer = layers[static_cast<size_t>(b[axis])];
          layer = std::max(layer, slot.error);
          columns[static_cast<size_t>(b[v]) * static_cast<size_t>(n[u]) + static_cast<size_t>(b[u])] +=
              slot.sum;
        }
    double error = 0.0;
    for (const double layer : layers) error += layer;
    worst = std::max(worst, error * kBrickCells * longestWay(volume.worldFromIndex));
    // The mean over a column's 8 x 8 lattice lines, at most the deepest of them.
    const glm::dvec4 side = volume.worldFromIndex[axis];
    const double voxel = std::sqrt(side.x * side.x + side.y * side.y + side.z * side.z);
    deepest = std::max(
        deepest, voxel * *std::max_element(columns.begin(), columns.end()) / (kBrickCells * kBrickCells));
  }
  return relative + (worst > 0.0 ? worst / deepest : 0.0);
}

Texel chooseTexel(const BrickVolume& volume) {
  for (const Texel texel : {Texel::r8, Texel::r16f})
    if (texelError(volume, texel) <= kTexelError) return texel;
  return Texel::r32f;
}

}  // namespace nephele
