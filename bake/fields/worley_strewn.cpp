// Each lane looks at the cells around its own point: the hash of a cell, its feature point, the squared
// distance. Which cells are skipped changes no result, so it may hang on the width of a vector. Depends on
// worley_strewn.h, Highway, shared text.
#include "bake/fields/worley_strewn.h"

#include <algorithm>

#include "bake/fields/shared_text.h"

// Vectors of a size that is unknown until run time can be held in no array, as this kernel does.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/worley_strewn.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/fields/noise_vectors.h"

#ifndef NEPHELE_WORLEY_RINGS
#define NEPHELE_WORLEY_RINGS
namespace nephele {

/// The 125 cells up to two away: first the 27 that touch the own cell, nearest first, then the outer 98.
struct CellsAround {
  static constexpr int kInner = 27, kAll = 125, kReach = 2, kEdge = 5;
  struct Offset {
    int8_t x, y, z;
  };
  Offset at[kAll] = {};
  constexpr CellsAround() {
    int count = 0;
    // Σ of squares goes up to 12: 3 at the inner corners.
    for (const bool outer : {false, true})
      for (int square = 0; square <= kReach * kReach * 3; ++square)
        for (int n = 0; n < kAll; ++n) {
          const int x = n / (kEdge * kEdge) - kReach, y = n / kEdge % kEdge - kReach, z = n % kEdge - kReach;
          const bool far = x * x > 1 || y * y > 1 || z * z > 1;
          if (far == outer && x * x + y * y + z * z == square)
            at[count++] = {int8_t(x), int8_t(y), int8_t(z)};
        }
  }
};
constexpr CellsAround kCellsAround;

}  // namespace nephele
#endif

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

// The rest of shared::hashCell, which WorleyKernels.StrewnPointsAgreeWithTheDefinition holds this to.
HWY_INLINE VU hashed(VU key) {
  constexpr uint32_t kMixSecond = 0x297a2d39u;
  const VU h = mixed(spread(key));
  return spread(hn::Mul(hn::Xor(h, hn::ShiftRight<12>(h)), hn::Set(TagU(), kMixSecond)));
}

// One axis for a vector of points: the place and the own cell's corner in the frame asked for, the keys of
// the five cells along it, and the squared gaps to them.
struct Along {
  V place, corner;
  VU key[CellsAround::kEdge];
  V gap[CellsAround::kEdge];

  // Written out, so that it is compiled for this target: g++ makes its own for the machine's least, which on
  // ARM may not call a vector's.
  HWY_INLINE Along() {}

  HWY_INLINE void set(const float* places, int32_t cell, Frame frame, uint32_t prime) {
    const Tag d;
    const TagU du;
    const hn::RebindToSigned<Tag> di;
    const V along = hn::LoadU(d, places), whole = hn::Floor(along);
    const V inside = hn::Sub(along, whole);
    place = frame == Frame::ownCell ? inside : along;
    corner = frame == Frame::ownCell ? hn::Zero(d) : whole;
    const VU own = hn::Add(hn::BitCast(du, hn::ConvertTo(di, whole)), hn::Set(du, uint32_t(cell)));
    const VU first = hn::Mul(own, hn::Set(du, prime));
    for (int n = 0; n < CellsAround::kEdge; ++n) {
      const int offset = n - CellsAround::kReach;
      key[n] = hn::Add(first, hn::Set(du, uint32_t(offset) * prime));
      const V low = hn::Set(d, float(offset)), one = hn::Set(d, 1.0f);
      const V away = hn::Max(hn::Max(hn::Sub(low, inside), hn::Sub(hn::Sub(inside, low), one)), hn::Zero(d));
      gap[n] = hn::Mul(away, away);
    }
  }
};

// shared::featurePoint along one axis, less the point's place: `bits` as the hash gives them.
HWY_INLINE V apart(VU bits, int offset, V jitter, const Along& axis) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  const V unit = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, bits)), hn::Set(d, 1.0f / 2048.0f));
  const V half = hn::Set(d, 0.5f);
  const V feature = hn::Add(half, hn::Mul(jitter, hn::Sub(unit, half)));
  return hn::Sub(hn::Add(hn::Add(axis.corner, hn::Set(d, float(offset))), feature), axis.place);
}

template <bool kSecond>
HWY_INLINE void nearest(const WorleyNoise& noise, const StrewnPlaces& places, Frame frame, size_t n, V& first,
                        V& second) {
  const Tag d;
  const TagU du;
  Along x, y, z;
  x.set(places.x + n, places.cellX, frame, kHashX);
  y.set(places.y + n, places.cellY, frame, kHashY);
  z.set(places.z + n, places.cellZ, frame, kHashZ);
  const VU seed = hn::Set(du, noise.seed), eleven = hn::Set(du, 0x7ffu);
  const V jitter = hn::Set(d, noise.jitter);
  // A part in 10^5 beyond what can matter, so that no rounding leaves out a cell that does.
  const V more = hn::Set(d, 1.00001f), least = hn::Set(d, 1e-6f);
  first = second = hn::Set(d, 9.0f);  // squared; above 3
  for (int c = 0; c < CellsAround::kAll; ++c) {
    const V worst = hn::Add(hn::Mul(kSecond ? second : first, more), least);
    // An outer cell is at least one away.
    if (c == CellsAround::kInner && hn::AllTrue(d, hn::Lt(worst, hn::Set(d, 1.0f)))) return;
    const CellsAround::Offset at = kCellsAround.at[c];
    const int ix = at.x + CellsAround::kReach, iy = at.y + CellsAround::kReach,
              iz = at.z + CellsAround::kReach;
    if (hn::AllTrue(d, hn::Gt(hn::Add(hn::Add(x.gap[ix], y.gap[iy]), z.gap[iz]), worst))) continue;
    const VU h = hashed(hn::Xor(hn::Xor(x.key[ix], y.key[iy]), hn::Xor(z.key[iz], seed)));
    const V ax = apart(hn::And(h, eleven), at.x, jitter, x);
    const V ay = apart(hn::And(hn::ShiftRight<11>(h), eleven), at.y, jitter, y);
    const V az = apart(hn::ShiftLeft<1>(hn::ShiftRight<22>(h)), at.z, jitter, z);
    const V squared = hn::Add(hn::Add(hn::Mul(ax, ax), hn::Mul(ay, ay)), hn::Mul(az, az));
    if (kSecond) second = hn::Min(second, hn::Max(first, squared));
    first = hn::Min(first, squared);
  }
}

bool strewn(const WorleyNoise& noise, const StrewnPlaces& places, Frame frame, size_t count, float* values) {
  const Tag d;
  const size_t lanes = hn::Lanes(d);
  for (size_t n = 0; n < count; n += lanes) {
    V first, second;
    V result;
    if (noise.output == WorleyOutput::f1) {
      nearest<false>(noise, places, frame, n, first, second);
      result = hn::Sqrt(first);
    } else {
      nearest<true>(noise, places, frame, n, first, second);
      result = hn::Sqrt(second);
      if (noise.output == WorleyOutput::f2MinusF1) result = hn::Sub(result, hn::Sqrt(first));
    }
    HWY_ALIGN float lane[16];
    hn::Store(result, d, lane);
    std::copy_n(lane, std::min(lanes, count - n), values + n);
  }
  return true;
}

#else

bool strewn(const WorleyNoise&, const StrewnPlaces&, Frame, size_t, float*) { return false; }

#endif

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(strewn);

bool worleyStrewn(const WorleyNoise& noise, const StrewnPlaces& places, Frame frame, size_t count,
                  float* values) {
  return HWY_DYNAMIC_DISPATCH(strewn)(noise, places, frame, count, values);
}

}  // namespace nephele
#endif
