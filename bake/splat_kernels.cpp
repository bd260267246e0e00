// What particles give to one leaf: sums, rows of 8 voxels, shaped particles, losses. Depends on
// splat_kernels.h, splat_rows-inl.h, Highway.
#include "bake/splat_kernels.h"

#include <bit>
#include <cmath>

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/splat_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/splat_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

double gaussianSum(const SplatRecord& p) {
  const float perSquare = 1.0f / (p.radius * p.radius);
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Span span = spanOf(p.rest[axis], p.radius);
    double sum = 0.0;
    for (int at = span.low; at <= span.high; at += kLeafEdge)
      sum += sumOf(gaussianFactors(at, p.rest[axis], perSquare));
    product *= sum;
  }
  return product;
}

template <class Kernel>
double radialSum(const SplatRecord& p) {
  const float perSquare = 1.0f / (p.radius * p.radius);
  const Span x = spanOf(p.rest[0], p.radius), y = spanOf(p.rest[1], p.radius),
             z = spanOf(p.rest[2], p.radius);
  double sum = 0.0;
  for (int zAt = z.low; zAt <= z.high; zAt += kLeafEdge) {
    Row dz = apartFrom(zAt, p.rest[2]);
    for (size_t k = 0; k < kParts; ++k)
      dz.part[k] = hn::Mul(hn::Mul(dz.part[k], dz.part[k]), hn::Set(D(), perSquare));
    for (int xAt = x.low; xAt <= x.high; ++xAt) {
      const float dx = float(xAt) - p.rest[0], dx2 = dx * dx * perSquare;
      Row plane = allEqual(0.0f);
      for (int yAt = y.low; yAt <= y.high; ++yAt) {
        const float dy = float(yAt) - p.rest[1], aside = dx2 + dy * dy * perSquare;
        if (aside >= 1.0f) continue;
        for (size_t k = 0; k < kParts; ++k)
          plane.part[k] = hn::Add(plane.part[k], Kernel::at(D(), hn::Add(dz.part[k], hn::Set(D(), aside))));
      }
      sum += sumOf(plane);
    }
  }
  return sum;
}

void sums(SplatKernel kernel, const SplatRecord* records, size_t count, double* out) {
  for (size_t n = 0; n < count; ++n)
    out[n] = kernel == SplatKernel::gaussian   ? gaussianSum(records[n])
             : kernel == SplatKernel::wendland ? radialSum<Wendland>(records[n])
                                               : radialSum<SmoothSphere>(records[n]);
}

template <bool kExtras>
HWY_INLINE void addRow(const Row& weights, const SplatExtras* extras, int offset, const SplatLeaf& leaf) {
  for (size_t k = 0; k < kParts; ++k) {
    const D d;
    const size_t at = size_t(offset) + k * kLanes;
    hn::StoreU(hn::Add(hn::LoadU(d, leaf.density + at), weights.part[k]), d, leaf.density + at);
    if constexpr (kExtras)
      for (size_t e = 0; e < 5; ++e)
        hn::StoreU(
            hn::Add(hn::LoadU(d, leaf.extra[e] + at), hn::Mul(weights.part[k], hn::Set(d, extras->value[e]))),
            d, leaf.extra[e] + at);
  }
}

/// The rows of a leaf that a particle reaches, and where the leaf's first voxel lies from the particle's
/// cell.
struct Clip {
  int first[3];
  Span x, y;

  HWY_INLINE Clip(const SplatRecord& p, const int32_t origin[3]) {
    for (int axis = 0; axis < 3; ++axis) first[axis] = origin[axis] - p.cell[axis];
    x = clipped(spanOf(p.rest[0], p.radius), first[0]);
    y = clipped(spanOf(p.rest[1], p.radius), first[1]);
  }
  static HWY_INLINE Span clipped(const Span& span, int first) {
    const int low = span.low - first, high = span.high - first;
    return {low > 0 ? low : 0, high < kLeafEdge - 1 ? high : kLeafEdge - 1};
  }
};

template <bool kExtras>
HWY_INLINE void gaussianIntoLeaf(const SplatRecord& p, const SplatExtras* extras, const int32_t origin[3],
                                 const SplatLeaf& leaf) {
  const Clip clip(p, origin);
  const float perSquare = 1.0f / (p.radius * p.radius);
  alignas(64) float ex[kLeafEdge], ey[kLeafEdge];
  stored(gaussianFactors(clip.first[0], p.rest[0], perSquare), ex);
  stored(gaussianFactors(clip.first[1], p.rest[1], perSquare), ey);
  Row ez = gaussianFactors(clip.first[2], p.rest[2], perSquare);
  for (size_t k = 0; k < kParts; ++k) ez.part[k] = hn::Mul(ez.part[k], hn::Set(D(), p.scale));
  for (int x = clip.x.low; x <= clip.x.high; ++x)
    for (int y = clip.y.low; y <= clip.y.high; ++y) {
      Row row;
      const auto aside = hn::Set(D(), ex[x] * ey[y]);
      for (size_t k = 0; k < kParts; ++k) row.part[k] = hn::Mul(ez.part[k], aside);
      addRow<kExtras>(row, extras, (x * kLeafEdge + y) * kLeafEdge, leaf);
    }
}

template <class Kernel, bool kExtras>
HWY_INLINE void radialIntoLeaf(const SplatRecord& p, const SplatExtras* extras, const int32_t origin[3],
                               const SplatLeaf& leaf) {
  const Clip clip(p, origin);
  const float perSquare = 1.0f / (p.radius * p.radius);
  Row dz = apartFrom(clip.first[2], p.rest[2]);
  for (size_t k = 0; k < kParts; ++k)
    dz.part[k] = hn::Mul(hn::Mul(dz.part[k], dz.part[k]), hn::Set(D(), perSquare));
  const auto scale = hn::Set(D(), p.scale);
  for (int x = clip.x.low; x <= clip.x.high; ++x) {
    const float dx = float(clip.first[0] + x) - p.rest[0], dx2 = dx * dx * perSquare;
    for (int y = clip.y.low; y <= clip.y.high; ++y) {
      const float dy = float(clip.first[1] + y) - p.rest[1], aside = dx2 + dy * dy * perSquare;
      if (aside >= 1.0f) continue;
      Row row;
      for (size_t k = 0; k < kParts; ++k)
        row.part[k] = hn::Mul(Kernel::at(D(), hn::Add(dz.part[k], hn::Set(D(), aside))), scale);
      addRow<kExtras>(row, extras, (x * kLeafEdge + y) * kLeafEdge, leaf);
    }
  }
}

template <bool kExtras>
void intoLeafWith(SplatKernel kernel, const SplatRecord* records, const SplatExtras* extras,
                  const uint32_t* list, size_t count, const int32_t origin[3], const SplatLeaf& leaf) {
  for (size_t n = 0; n < count; ++n) {
    const SplatRecord& p = records[list[n]];
    const SplatExtras* const own = kExtras ? extras + list[n] : nullptr;
    if (kernel == SplatKernel::gaussian)
      gaussianIntoLeaf<kExtras>(p, own, origin, leaf);
    else if (kernel == SplatKernel::wendland)
      radialIntoLeaf<Wendland, kExtras>(p, own, origin, leaf);
    else
      radialIntoLeaf<SmoothSphere, kExtras>(p, own, origin, leaf);
  }
}

void intoLeaf(SplatKernel kernel, const SplatRecord* records, const SplatExtras* extras, const uint32_t* list,
              size_t count, const int32_t origin[3], const SplatLeaf& leaf) {
  if (extras)
    intoLeafWith<true>(kernel, records, extras, list, count, origin, leaf);
  else
    intoLeafWith<false>(kernel, records, extras, list, count, origin, leaf);
}

/// Squared distances in radii from a row of voxels to the line that a particle is drawn along.
struct Line {
  float along[3], perSquare, perLength;  // perLength: 1/|along|², 0 where there is no line

  HWY_INLINE V at(float dx, float dy, V dz) const {
    const D d;
    const auto dotted = hn::Add(hn::Set(d, dx * along[0] + dy * along[1]), hn::Mul(dz, hn::Set(d, along[2])));
    const auto t =
        hn::Max(hn::Min(hn::Mul(dotted, hn::Set(d, perLength)), hn::Set(d, 0.5f)), hn::Set(d, -0.5f));
    const auto ex = hn::Sub(hn::Set(d, dx), hn::Mul(t, hn::Set(d, along[0])));
    const auto ey = hn::Sub(hn::Set(d, dy), hn::Mul(t, hn::Set(d, along[1])));
    const auto ez = hn::Sub(dz, hn::Mul(t, hn::Set(d, along[2])));
    const auto squared = hn::Add(hn::Add(hn::Mul(ex, ex), hn::Mul(ey, ey)), hn::Mul(ez, ez));
    return hn::Mul(squared, hn::Set(d, perSquare));
  }
};

/// Squared distances in radii where a field has eaten into the particle.
HWY_INLINE V eaten(V squared, const float* field, float erosion) {
  const D d;
  const auto depth = hn::Mul(hn::Max(hn::LoadU(d, field), hn::Zero(d)), hn::Set(d, erosion));
  const auto q = hn::Add(hn::Sqrt(squared), depth);
  return hn::Mul(q, q);
}

template <class Kernel>
double shapedWith(const SplatRecord& p, const SplatShape& shape, const int32_t origin[3], const float* field,
                  float* weights) {
  const D d;
  const float* const s = shape.stretch;
  const float length = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
  const Line line{{s[0], s[1], s[2]}, 1.0f / (p.radius * p.radius), length > 0.0f ? 1.0f / length : 0.0f};
  int first[3];
  for (int axis = 0; axis < 3; ++axis) first[axis] = origin[axis] - p.cell[axis];
  const Row dz = apartFrom(first[2], p.rest[2]);
  double sum = 0.0;
  for (int x = 0; x < kLeafEdge; ++x) {
    Row plane = allEqual(0.0f);
    for (int y = 0; y < kLeafEdge; ++y) {
      const float dx = float(first[0] + x) - p.rest[0], dy = float(first[1] + y) - p.rest[1];
      const size_t offset = size_t(x * kLeafEdge + y) * kLeafEdge;
      for (size_t k = 0; k < kParts; ++k) {
        auto squared = line.at(dx, dy, dz.part[k]);
        if (field) squared = eaten(squared, field + offset + k * kLanes, shape.erosion);
        const auto weight = Kernel::at(D(), squared);
        hn::StoreU(weight, d, weights + offset + k * kLanes);
        plane.part[k] = hn::Add(plane.part[k], weight);
      }
    }
    sum += sumOf(plane);
  }
  return sum;
}

template <class Kernel>
void shapedAtWith(size_t count, const float* squared, const float* field, float erosion, float* weights) {
  const D d;
  for (size_t n = 0; n < count; n += kLanes) {
    const auto own = hn::LoadU(d, squared + n);
    hn::StoreU(Kernel::at(d, field ? eaten(own, field + n, erosion) : own), d, weights + n);
  }
}

void shapedAt(SplatKernel kernel, size_t count, const float* squared, const float* field, float erosion,
              float* weights) {
  kernel == SplatKernel::gaussian   ? shapedAtWith<Gaussian>(count, squared, field, erosion, weights)
  : kernel == SplatKernel::wendland ? shapedAtWith<Wendland>(count, squared, field, erosion, weights)
                                    : shapedAtWith<SmoothSphere>(count, squared, field, erosion, weights);
}

SplatLosses losses(const float* before, const float* stored, float cutoff) {
  const D d;
  Row all = allEqual(0.0f), cut = all, rounded = all;
  for (size_t at = 0; at < kLeafVoxels; at += kLeafEdge)
    for (size_t k = 0; k < kParts; ++k) {
      const auto value = hn::LoadU(d, before + at + k * kLanes),
                 left = hn::LoadU(d, stored + at + k * kLanes);
      const auto kept = hn::Gt(value, hn::Set(d, cutoff));
      all.part[k] = hn::Add(all.part[k], value);
      cut.part[k] = hn::Add(cut.part[k], hn::IfThenZeroElse(kept, value));
      rounded.part[k] = hn::Add(rounded.part[k], hn::IfThenElseZero(kept, hn::Sub(value, left)));
    }
  return {sumOf(all), sumOf(cut), sumOf(rounded)};
}

double shaped(SplatKernel kernel, const SplatRecord& p, const SplatShape& shape, const int32_t origin[3],
              const float* field, float* weights) {
  return kernel == SplatKernel::gaussian   ? shapedWith<Gaussian>(p, shape, origin, field, weights)
         : kernel == SplatKernel::wendland ? shapedWith<Wendland>(p, shape, origin, field, weights)
                                           : shapedWith<SmoothSphere>(p, shape, origin, field, weights);
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(sums);
HWY_EXPORT(intoLeaf);
HWY_EXPORT(shaped);
HWY_EXPORT(shapedAt);
HWY_EXPORT(losses);

void splatSums(SplatKernel kernel, const SplatRecord* records, size_t count, double* sums) {
  HWY_DYNAMIC_DISPATCH(sums)(kernel, records, count, sums);
}

void splatIntoLeaf(SplatKernel kernel, const SplatRecord* records, const SplatExtras* extras,
                   const uint32_t* list, size_t count, const int32_t origin[3], const SplatLeaf& leaf) {
  HWY_DYNAMIC_DISPATCH(intoLeaf)(kernel, records, extras, list, count, origin, leaf);
}

double splatShaped(SplatKernel kernel, const SplatRecord& record, const SplatShape& shape,
                   const int32_t origin[3], const float* field, float* weights) {
  return HWY_DYNAMIC_DISPATCH(shaped)(kernel, record, shape, origin, field, weights);
}

void splatShapedAt(SplatKernel kernel, size_t count, const float* squared, const float* field, float erosion,
                   float* weights) {
  HWY_DYNAMIC_DISPATCH(shapedAt)(kernel, count, squared, field, erosion, weights);
}

SplatLosses splatLosses(const float* before, const float* stored, float cutoff) {
  return HWY_DYNAMIC_DISPATCH(losses)(before, stored, cutoff);
}

void roundToHalf(float* values, size_t count) {
  // Below 2^−14 halves are multiples of 2^−24, which adding and taking away ½ rounds to; above, a float's
  // last 13 bits go.
  constexpr float kSmallestNormal = 6.103515625e-5f;
  constexpr uint32_t kDropped = 0x1fff, kHalfway = 0x0fff;
  constexpr int kDroppedBits = 13;
  for (size_t n = 0; n < count; ++n) {
    const float v = values[n];
    const float size = std::abs(v);
    const float small = v < 0.0f ? -((size + 0.5f) - 0.5f) : (size + 0.5f) - 0.5f;
    const uint32_t bits = std::bit_cast<uint32_t>(v);
    const float large = std::bit_cast<float>((bits + kHalfway + ((bits >> kDroppedBits) & 1u)) & ~kDropped);
    values[n] = size < kSmallestNormal ? small : large;
  }
}

}  // namespace nephele
#endif
