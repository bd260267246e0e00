// Gradient noise at points by SIMD. How far a batch of points reaches decides how corners are found: by one
// of the ways of noise_near.h, or by hashing corner by corner. All give equal bits. Depends on perlin.h,
// Highway.
#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/shared_text.h"

#ifndef NEPHELE_NOISE_POINTS_ONCE
#define NEPHELE_NOISE_POINTS_ONCE
namespace nephele {

/// Where a batch of points begins in an octave, and how to its cells.
struct OctavePlaces {
  explicit OctavePlaces(const NoiseOctave& octave, const glm::dvec3& origin)
      : x(cellPlace(origin.x - octave.offset.x, octave.cellSize)),
        y(cellPlace(origin.y - octave.offset.y, octave.cellSize)),
        z(cellPlace(origin.z - octave.offset.z, octave.cellSize)),
        frequency(float(1.0 / octave.cellSize)) {}
  CellPlace x, y, z;
  float frequency;  // cells in a world unit
};

/// Points from `first` on, by the definition.
void addNoiseByDefinition(const NoiseOctave& octave, const Points& points, size_t first, float* sums);

}  // namespace nephele
#endif

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/noise_points.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/fields/noise_near.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

// Noise is a functor of places given relative to the batch's first cell. This one takes places anywhere.
// kMayShare: it asks first whether all of a vector lie in one cell; the answer changes no bits.
template <bool kMayShare, class Gradients>
struct AnywhereNoise {
  const Gradients& table;
  const OctavePlaces& places;
  uint32_t seed;
  V scale;

  HWY_INLINE V operator()(V x, V y, V z) const {
    const Tag d;
    const V wx = hn::Floor(x), wy = hn::Floor(y), wz = hn::Floor(z);
    const V x0 = hn::Sub(x, wx), y0 = hn::Sub(y, wy), z0 = hn::Sub(z, wz);
    if (kMayShare) {
      const float ax = hn::GetLane(wx), ay = hn::GetLane(wy), az = hn::GetLane(wz);
      const auto strays =
          hn::Or(hn::Or(hn::Ne(wx, hn::Set(d, ax)), hn::Ne(wy, hn::Set(d, ay))), hn::Ne(wz, hn::Set(d, az)));
      if (hn::AllFalse(d, strays)) return inOneCell({ax, ay, az}, x0, y0, z0);
    }
    const VU plainX = hashed(wx, places.x, kHashX), plainY = hashed(wy, places.y, kHashY),
             plainZ = hashed(wz, places.z, kHashZ);
    const TagU du;
    const VU seeds = hn::Set(du, seed);
    const VU hx[2] = {spread(plainX), spread(hn::Add(plainX, hn::Set(du, kHashX)))};
    const VU hy[2] = {spread(plainY), spread(hn::Add(plainY, hn::Set(du, kHashY)))};
    const VU hz[2] = {spread(hn::Xor(plainZ, seeds)),
                      spread(hn::Xor(hn::Add(plainZ, hn::Set(du, kHashZ)), seeds))};
    return mixHashed(table, hx, hy, hz, x0, y0, z0, scale);
  }

 private:
  static HWY_INLINE VU hashed(V whole, const CellPlace& first, uint32_t prime) {
    const TagU du;
    const hn::RebindToSigned<Tag> di;
    const VU at = hn::Add(hn::BitCast(du, hn::ConvertTo(di, whole)), hn::Set(du, uint32_t(first.cell)));
    return hn::Mul(at, hn::Set(du, prime));
  }

  HWY_INLINE V inOneCell(const glm::vec3& cell, V x0, V y0, V z0) const {
    const glm::ivec3 at(cellAfter(places.x.cell, cell.x), cellAfter(places.y.cell, cell.y),
                        cellAfter(places.z.cell, cell.z));
    return mixCell(x0, y0, z0, scale, [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz) HWY_ATTR {
      const glm::ivec3 corner(int32_t(uint32_t(at.x) + ox), int32_t(uint32_t(at.y) + oy),
                              int32_t(uint32_t(at.z) + oz));
      return dotWithOne(table.of(shared::hashCorner(corner, seed)), dx, dy, dz);
    });
  }
};

// Whether a vector of neighbouring points mostly lies in one cell, judged by one in the middle: the chance is
// one less the way from its first point to its last, in cells.
HWY_INLINE bool oftenShared(const Points& points, float frequency, size_t lanes) {
  if (points.count < lanes) return false;
  const size_t first = (points.count - lanes) / 2, last = first + lanes - 1;
  const auto way = [&](const float* at) { return std::abs(at[last] - at[first]) * frequency; };
  return way(points.x) + way(points.y) + way(points.z) < 0.5f;
}

// Whole vectors of points from the first on; returns how many points those are.
template <class Noise>
HWY_INLINE size_t addVectors(const Noise& noise, const OctavePlaces& places, float octaveWeight,
                             const Points& points, float* sums) {
  const Tag d;
  const size_t lanes = hn::Lanes(d);
  const V frequency = hn::Set(d, places.frequency), weight = hn::Set(d, octaveWeight);
  size_t n = 0;
  for (; n + lanes <= points.count; n += lanes) {
    const V x = hn::Add(hn::Set(d, places.x.fraction), hn::Mul(hn::LoadU(d, points.x + n), frequency));
    const V y = hn::Add(hn::Set(d, places.y.fraction), hn::Mul(hn::LoadU(d, points.y + n), frequency));
    const V z = hn::Add(hn::Set(d, places.z.fraction), hn::Mul(hn::LoadU(d, points.z + n), frequency));
    hn::StoreU(hn::Add(hn::LoadU(d, sums + n), hn::Mul(weight, noise(x, y, z))), d, sums + n);
  }
  return n;
}

// The least and the largest coordinate of points along each axis.
struct Span {
  float low[3], high[3];
};

HWY_INLINE Span spanOf(const Points& points) {
  const Tag d;
  const size_t lanes = hn::Lanes(d);
  Span span;
  const float* const axes[3] = {points.x, points.y, points.z};
  for (size_t axis = 0; axis < 3; ++axis) {
    const float* const at = axes[axis];
    V least = hn::Set(d, at[0]), most = least;
    size_t n = 0;
    for (; n + lanes <= points.count; n += lanes) {
      const V v = hn::LoadU(d, at + n);
      least = hn::Min(least, v);
      most = hn::Max(most, v);
    }
    span.low[axis] = hn::GetLane(hn::MinOfLanes(d, least));
    span.high[axis] = hn::GetLane(hn::MaxOfLanes(d, most));
  }
  return span;
}

// Returns how many points were done, from the first on.
template <class Gradients>
HWY_INLINE size_t addWith(const Gradients& table, const NoiseOctave& octave, const Span& span,
                          const Points& points, float* sums) {
  const OctavePlaces places(octave, points.origin);
  const V scale = hn::Set(Tag(), noiseScale(octave));
  const auto add = [&](const auto& noise)
                       HWY_ATTR { return addVectors(noise, places, octave.weight, points, sums); };
  const Planes px(places.x, places.frequency, span.low[0], span.high[0], octave.period, kHashX),
      py(places.y, places.frequency, span.low[1], span.high[1], octave.period, kHashY),
      pz(places.z, places.frequency, span.low[2], span.high[2], octave.period, kHashZ);
  const int corners = px.count * py.count * pz.count;
  if (corners == 8) return add(oneCell(table, px, py, pz, octave.seed, scale));
#if HWY_MAX_BYTES >= 64
  if (corners > 0 && corners <= 16) return add(fewCorners(table, px, py, pz, octave.seed, scale));
  if (corners > 0) return add(keyed(table, px, py, pz, octave.seed, scale));
#endif
  if (octave.period != 0) return 0;  // folding costs a division a corner
  if (oftenShared(points, places.frequency, hn::Lanes(Tag())))
    return add(AnywhereNoise<true, Gradients>{table, places, octave.seed, scale});
  return add(AnywhereNoise<false, Gradients>{table, places, octave.seed, scale});
}

void addAtPoints(const NoiseOctave* octaves, size_t count, const Points& points, float* sums) {
  if (points.count == 0) return;
  const Span span = spanOf(points);
  for (size_t n = 0; n < count; ++n) {
    const NoiseOctave& octave = octaves[n];
    const size_t done = octave.turn.evolves
                            ? addWith(TurnedGradients{octave.turn}, octave, span, points, sums)
                            : addWith(PlainGradients(), octave, span, points, sums);
    addNoiseByDefinition(octave, points, done, sums);
  }
}

#else

void addAtPoints(const NoiseOctave* octaves, size_t count, const Points& points, float* sums) {
  for (size_t n = 0; n < count; ++n) addNoiseByDefinition(octaves[n], points, 0, sums);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(addAtPoints);

void addNoiseByDefinition(const NoiseOctave& octave, const Points& points, size_t first, float* sums) {
  const OctavePlaces places(octave, points.origin);
  for (size_t n = first; n < points.count; ++n) {
    const float x = places.x.fraction + points.x[n] * places.frequency;
    const float y = places.y.fraction + points.y[n] * places.frequency;
    const float z = places.z.fraction + points.z[n] * places.frequency;
    const float wx = std::floor(x), wy = std::floor(y), wz = std::floor(z);
    sums[n] += octave.weight * noiseInCell(octave,
                                           {cellAfter(places.x.cell, wx), cellAfter(places.y.cell, wy),
                                            cellAfter(places.z.cell, wz)},
                                           {x - wx, y - wy, z - wz});
  }
}

void addNoiseAtPoints(const NoiseOctave* octaves, size_t count, const Points& points, float* sums) {
  HWY_DYNAMIC_DISPATCH(addAtPoints)(octaves, count, points, sums);
}

}  // namespace nephele
#endif
