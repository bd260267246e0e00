// Halves, 8-bit samples and their errors. Depends on base/half.h, volume/brick_bounds.h and TBB.
#include "volume/brick_texel.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "base/half.h"
#include "volume/brick_bounds.h"

namespace nephele {
namespace {

constexpr int kHalfMantissa = 10, kFloatMantissa = 23, kDropped = kFloatMantissa - kHalfMantissa;
constexpr uint32_t kRebias = (127u - 15u)
                             << kHalfMantissa;  // between the exponents' offsets, in a half's places
constexpr uint32_t kHalfInfinity = 31u << kHalfMantissa;
constexpr float kLeastNormalHalf = 6.103515625e-5f;  // 2^-14
constexpr float kByte = 255.0f;

/// Worst error of a slot's samples: its relative part, and the rest.
struct SlotErrors {
  double error = 0.0, relative = 0.0;
};

// Of a half's normal values; what goes beyond it is counted as it is.
constexpr double kHalfRelative = 0x1p-11;

template <Texel texel>
SlotErrors errorsOf(const float* samples, float maximum) {
  const float scale = brick_bounds::bound(
      brick_bounds::codeFor(*std::max_element(samples, samples + kBrickVolume), maximum), maximum);
  constexpr double kTiny = 1e-300;
  constexpr double allowed = texel == Texel::r16f ? kHalfRelative : 0.0;
  SlotErrors errors;
  for (int i = 0; i < kBrickVolume; ++i) {
    const double value = double{samples[i]};
    const double error = std::abs(double{keptAs(texel, samples[i], scale)} - value);
    if (!(error > 0.0)) continue;  // most samples of a file of halves
    errors.relative = std::max(errors.relative, std::min(error, allowed * value) / std::max(value, kTiny));
    errors.error = std::max(errors.error, error - allowed * value);
  }
  return errors;
}

/// The sum of a slot's samples at the lower 8 of each axis.
double sumOf(const float* samples) {
  double sum = 0.0;
  for (int z = 0; z < kBrickCells; ++z)
    for (int y = 0; y < kBrickCells; ++y)
      for (int x = 0; x < kBrickCells; ++x)
        sum += double{samples[(z * kBrickSamples + y) * kBrickSamples + x]};
  return sum;
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

const float* slotOf(const BrickVolume& volume, size_t slot) {
  return volume.samples.data() + slot * kBrickVolume;
}

/// Calls `take(brick, slot)` for each brick that is kept.
template <class Take>
void forEachSlot(const BrickVolume& volume, const Take& take) {
  size_t i = 0;
  for (glm::ivec3 b(0); b.z < volume.brickCount.z; ++b.z)
    for (b.y = 0; b.y < volume.brickCount.y; ++b.y)
      for (b.x = 0; b.x < volume.brickCount.x; ++b.x, ++i)
        if (volume.index[i] != 0) take(b, volume.index[i] - 1);
}

/// The deepest ∫ ρ ds, world units, of the means over columns of bricks along the axes: of each column's 8 x
/// 8 lattice lines, of which one is at least as deep.
double deepestColumn(const BrickVolume& volume) {
  std::vector<double> sums(volume.slotCount());
  tbb::parallel_for(size_t{0}, sums.size(), [&](size_t slot) { sums[slot] = sumOf(slotOf(volume, slot)); });
  const glm::ivec3 n = volume.brickCount;
  double deepest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<double> columns(static_cast<size_t>(n[u]) * static_cast<size_t>(n[v]), 0.0);
    forEachSlot(volume, [&](const glm::ivec3& b, size_t slot) {
      columns[static_cast<size_t>(b[v]) * static_cast<size_t>(n[u]) + static_cast<size_t>(b[u])] +=
          sums[slot];
    });
    const glm::dvec4 side = volume.worldFromIndex[axis];
    const double voxel = std::sqrt(side.x * side.x + side.y * side.y + side.z * side.z);
    deepest = std::max(
        deepest, voxel * *std::max_element(columns.begin(), columns.end()) / (kBrickCells * kBrickCells));
  }
  return deepest;
}

/// texelError by every `apart`th slot alone, which is at most that of all; `deepest` is deepestColumn().
double errorOfSlots(const BrickVolume& volume, Texel texel, double deepest, size_t apart) {
  std::vector<SlotErrors> errors(volume.slotCount());
  const float maximum = static_cast<float>(volume.maximum);
  tbb::parallel_for(size_t{0}, errors.size(), apart, [&](size_t slot) {
    const float* samples = slotOf(volume, slot);
    errors[slot] =
        texel == Texel::r8 ? errorsOf<Texel::r8>(samples, maximum) : errorsOf<Texel::r16f>(samples, maximum);
  });
  double worst = 0.0, relative = 0.0;
  for (const SlotErrors& slot : errors) relative = std::max(relative, slot.relative);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> layers(static_cast<size_t>(volume.brickCount[axis]), 0.0);
    forEachSlot(volume, [&](const glm::ivec3& b, size_t slot) {
      double& layer = layers[static_cast<size_t>(b[axis])];
      layer = std::max(layer, errors[slot].error);
    });
    double error = 0.0;
    for (const double layer : layers) error += layer;
    worst = std::max(worst, error * kBrickCells * longestWay(volume.worldFromIndex));
  }
  return relative + (worst > 0.0 ? worst / deepest : 0.0);
}

/// What texelError of halves is at most, as far as the largest density alone tells.
double halvesErrAtMost(const BrickVolume& volume, double deepest) {
  if (volume.maximum > double{kLargestHalf}) return std::numeric_limits<double>::infinity();
  const int layers = std::max({volume.brickCount.x, volume.brickCount.y, volume.brickCount.z});
  const double worst = 0.5 * double{kLeastHalf} * layers * kBrickCells * longestWay(volume.worldFromIndex);
  return kHalfRelative + worst / deepest;
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
  if (value < kLeastNormalHalf) return static_cast<uint16_t>(std::nearbyint(value / kLeastHalf));
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const uint32_t odd = bits >> kDropped & 1u;
  const uint32_t half = ((bits + (1u << (kDropped - 1)) - 1u + odd) >> kDropped) - kRebias;
  return static_cast<uint16_t>(std::min(half, kHalfInfinity));
}

float fromHalf(uint16_t half) {
  if (half < 1u << kHalfMantissa) return static_cast<float>(half) * kLeastHalf;
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
  return errorOfSlots(volume, texel, deepestColumn(volume), 1);
}

Texel chooseTexel(const BrickVolume& volume) {
  if (volume.empty()) return Texel::r8;
  const double deepest = deepestColumn(volume);
  // A few slots mostly tell that bytes are too coarse, and the largest density that halves are not.
  constexpr size_t kFew = 16;
  const auto isGood = [&](Texel texel, size_t apart) {
    return errorOfSlots(volume, texel, deepest, apart) <= kTexelError;
  };
  if (isGood(Texel::r8, kFew) && isGood(Texel::r8, 1)) return Texel::r8;
  if (halvesErrAtMost(volume, deepest) <= kTexelError || isGood(Texel::r16f, 1)) return Texel::r16f;
  return Texel::r32f;
}

}  // namespace nephele
