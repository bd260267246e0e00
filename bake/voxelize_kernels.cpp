// The pass over a leaf, one vector after the other. Depends on voxelize_kernels.h, Highway.
#include "bake/voxelize_kernels.h"

#include <cstring>
#include <limits>

// Vectors of a size that is unknown until run time can be held in no array, as this kernel does.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/voxelize_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Sums have 16 lanes of their own whatever a vector holds, so that they are the same on every target.
constexpr size_t kSumLanes = 16;
constexpr size_t kValues = 512;
constexpr size_t kWordBits = 64;
constexpr size_t kTargetLanes = HWY_TARGET == HWY_SCALAR ? 1 : HWY_MAX_BYTES / sizeof(float);
constexpr size_t kLanes = kTargetLanes < kSumLanes ? kTargetLanes : kSumLanes;
constexpr size_t kParts = kSumLanes / kLanes;
using Tag = hn::CappedTag<float, kLanes>;
using V = hn::Vec<Tag>;

constexpr float kLeastHalf = 5.9604644775390625e-8f;  // 2^-24

// To half precision and back, ties to even, for 0 <= v <= 65504.
HWY_INLINE V throughHalf(V v) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  // Of a normal number 13 of the 23 bits go: half of the last kept bit is added, less one where it is even.
  constexpr int kLost = 13;
  const auto bits = hn::BitCast(du, v);
  const auto odd = hn::And(hn::ShiftRight<kLost>(bits), hn::Set(du, 1u));
  const auto raised = hn::Add(bits, hn::Add(odd, hn::Set(du, (1u << (kLost - 1)) - 1u)));
  const V normal = hn::BitCast(d, hn::And(raised, hn::Set(du, ~((1u << kLost) - 1u))));
  // Below 2^-14 halves are multiples of 2^-24, as floats from 0.5 to 1 are.
  constexpr float kLeastNormal = 6.103515625e-5f;
  const V shift = hn::Set(d, 0.5f);
  return hn::IfThenElse(hn::Lt(v, hn::Set(d, kLeastNormal)), hn::Sub(hn::Add(v, shift), shift), normal);
}

// To multiples of `step`, or of the power of two below v where that is less, but not than `least`; ties to
// even, for 0 <= v <= limit. What exceeds the limit then is rounded down.
HWY_INLINE V throughStep(V v, V step, V least, V limit) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  constexpr uint32_t kExponent = 0x7f800000u;
  const V power = hn::BitCast(d, hn::And(hn::BitCast(du, v), hn::Set(du, kExponent)));
  const V unit = hn::Max(hn::Min(step, power), least);
  // Floats from 2^23 to 2^24 units are whole units, and so are all above.
  const V shift = hn::Mul(unit, hn::Set(d, 0x1p23f));
  const V whole = hn::Sub(hn::Add(v, shift), shift);
  const V rounded = hn::IfThenElse(hn::Lt(v, shift), whole, v);
  return hn::IfThenElse(hn::Gt(rounded, limit), hn::Sub(rounded, unit), rounded);
}

// The mask's bits, lane 0 lowest.
HWY_INLINE uint64_t bitsOf(hn::Mask<Tag> mask) {
  uint8_t bytes[8] = {};  // what StoreMaskBits may write
  hn::StoreMaskBits(Tag(), mask, bytes);
  uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits & ((uint64_t(1) << kLanes) - 1);
}

template <bool kHalf, bool kStep>
HWY_INLINE void scan(const LeafRules& rules, float* values, LeafScan& result) {
  const Tag d;
  const V zero = hn::Zero(d), cutoff = hn::Set(d, rules.cutoff), limit = hn::Set(d, rules.limit),
          step = hn::Set(d, rules.step), unit = hn::Set(d, kHalf ? kLeastHalf : 0.0f),
          least = hn::Set(d, -std::numeric_limits<float>::max());
  V mass[kParts], largest[kParts];
  for (size_t part = 0; part < kParts; ++part) mass[part] = largest[part] = zero;
  auto good = hn::Eq(zero, zero);
  uint64_t any = 0;
  for (size_t n = 0; n < kValues; n += kWordBits) {
    uint64_t bits = 0;
    for (size_t k = 0; k < kWordBits; k += kSumLanes)
      for (size_t part = 0; part < kParts; ++part) {
        const size_t at = k + part * kLanes;
        const V given = hn::LoadU(d, values + n + at);
        good = hn::And(good, hn::And(hn::Le(given, limit), hn::Ge(given, least)));
        V kept = hn::IfThenElseZero(hn::Gt(given, cutoff), given);
        if (kStep) kept = throughStep(kept, step, unit, limit);
        if (kHalf) kept = hn::IfThenElseZero(hn::Gt(kept, zero), throughHalf(kept));
        hn::StoreU(kept, d, values + n + at);
        bits |= bitsOf(hn::Gt(kept, zero)) << at;
        mass[part] = hn::Add(mass[part], kept);
        largest[part] = hn::Max(largest[part], kept);
      }
    result.mask[n / kWordBits] = bits;
    any |= bits;
  }
  result.active = any != 0;
  result.storable = hn::AllTrue(d, good);
  for (size_t part = 0; part < kParts; ++part) {
    float sums[kLanes], most[kLanes];
    hn::StoreU(mass[part], d, sums);
    hn::StoreU(largest[part], d, most);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      result.mass += double(sums[lane]);
      result.maximum = result.maximum < most[lane] ? most[lane] : result.maximum;
    }
  }
}

void scanOnTarget(const LeafRules& rules, float* values, LeafScan* result) {
  if (rules.half && rules.step > 0.0f)
    scan<true, true>(rules, values, *result);
  else if (rules.half)
    scan<true, false>(rules, values, *result);
  else if (rules.step > 0.0f)
    scan<false, true>(rules, values, *result);
  else
    scan<false, false>(rules, values, *result);
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(scanOnTarget);

LeafScan scanLeaf(const LeafRules& rules, float* values) {
  LeafScan result;
  HWY_DYNAMIC_DISPATCH(scanOnTarget)(rules, values, &result);
  return result;
}

}  // namespace nephele
#endif
