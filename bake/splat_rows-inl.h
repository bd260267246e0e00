// Rows of 8 voxels by SIMD, and the splat's kernels on them: included once for each target by the files that
// use them. Depends on splat_kernels.h, Highway.
#if defined(NEPHELE_SPLAT_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef NEPHELE_SPLAT_ROWS_INL_H
#undef NEPHELE_SPLAT_ROWS_INL_H
#else
#define NEPHELE_SPLAT_ROWS_INL_H
#endif

#include <hwy/highway.h>

#include "bake/splat_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kLeafEdge>;
using V = hn::Vec<D>;
constexpr size_t kLanes = hn::MaxLanes(D());
constexpr size_t kParts = size_t(kLeafEdge) / kLanes;

/// Eight floats, in as many registers as the target needs.
struct Row {
  V part[kParts];
};

HWY_INLINE Row allEqual(float value) {
  Row row;
  for (size_t k = 0; k < kParts; ++k) row.part[k] = hn::Set(D(), value);
  return row;
}

HWY_INLINE Row loaded(const float* values) {
  Row row;
  for (size_t k = 0; k < kParts; ++k) row.part[k] = hn::LoadU(D(), values + k * kLanes);
  return row;
}

HWY_INLINE void stored(const Row& row, float* values) {
  for (size_t k = 0; k < kParts; ++k) hn::StoreU(row.part[k], D(), values + k * kLanes);
}

/// Distances along an axis from a particle to the 8 voxels from `first` on (relative to its cell).
HWY_INLINE Row apartFrom(int first, float rest) {
  alignas(64) float at[kLeafEdge];
  for (int n = 0; n < kLeafEdge; ++n) at[n] = float(first + n) - rest;
  return loaded(at);
}

HWY_INLINE double sumOf(const Row& row) {
  float values[kLeafEdge];
  stored(row, values);
  double sum = 0.0;
  for (const float v : values) sum += double(v);
  return sum;
}

/// e^x for −80 ≤ x ≤ 0, by the operations of the shared text's exponential().
template <class Tag>
HWY_INLINE hn::Vec<Tag> exponentialOf(Tag d, hn::Vec<Tag> x) {
  const auto k = hn::Floor(hn::Add(hn::Mul(x, hn::Set(d, 1.44269504f)), hn::Set(d, 0.5f)));
  const auto r =
      hn::Sub(hn::Sub(x, hn::Mul(k, hn::Set(d, 0.693359375f))), hn::Mul(k, hn::Set(d, -2.12194440e-4f)));
  auto series = hn::Add(hn::Set(d, 1.0f / 720.0f), hn::Mul(r, hn::Set(d, 1.0f / 5040.0f)));
  for (const float term : {1.0f / 120.0f, 1.0f / 24.0f, 1.0f / 6.0f, 0.5f})
    series = hn::Add(hn::Set(d, term), hn::Mul(r, series));
  const auto power = hn::Add(hn::Set(d, 1.0f), hn::Add(r, hn::Mul(hn::Mul(r, r), series)));
  const hn::RebindToSigned<Tag> di;
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, k), hn::Set(di, 127)));
  return hn::Mul(power, hn::BitCast(d, exponent));
}

// The Gaussian ends at three standard deviations.
constexpr float kGaussianRate = 4.5f;

/// A kernel of the squared distance in radii; 0 from 1 on.
struct Wendland {
  static constexpr SplatKernel kName = SplatKernel::wendland;
  /// (1 − q)⁴ (4q + 1) [Wendland 1995, C2].
  template <class Tag>
  static HWY_INLINE hn::Vec<Tag> at(Tag d, hn::Vec<Tag> squared) {
    const auto q = hn::Sqrt(squared);
    const auto t = hn::Max(hn::Sub(hn::Set(d, 1.0f), q), hn::Zero(d));
    const auto t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(t2, t2), hn::Add(hn::Mul(q, hn::Set(d, 4.0f)), hn::Set(d, 1.0f)));
  }
};
struct SmoothSphere {
  static constexpr SplatKernel kName = SplatKernel::smoothSphere;
  /// 1 up to half the radius, then s² (3 − 2s), s = (1 − q²)/(3/4).
  template <class Tag>
  static HWY_INLINE hn::Vec<Tag> at(Tag d, hn::Vec<Tag> squared) {
    const auto one = hn::Set(d, 1.0f);
    const auto s =
        hn::Min(hn::Max(hn::Mul(hn::Sub(one, squared), hn::Set(d, 4.0f / 3.0f)), hn::Zero(d)), one);
    return hn::Mul(hn::Mul(s, s), hn::Sub(hn::Set(d, 3.0f), hn::Add(s, s)));
  }
};
struct Gaussian {
  static constexpr SplatKernel kName = SplatKernel::gaussian;
  template <class Tag>
  static HWY_INLINE hn::Vec<Tag> at(Tag d, hn::Vec<Tag> squared) {
    const auto nearer = hn::Min(squared, hn::Set(d, 1.0f));
    const auto value = exponentialOf(d, hn::Mul(nearer, hn::Set(d, -kGaussianRate)));
    return hn::IfThenElseZero(hn::Lt(squared, hn::Set(d, 1.0f)), value);
  }
};

/// The Gaussian's factor of one axis: it ends on the faces of a cube.
HWY_INLINE Row gaussianFactors(int first, float rest, float perSquare) {
  Row row = apartFrom(first, rest);
  for (size_t k = 0; k < kParts; ++k)
    row.part[k] = Gaussian::at(D(), hn::Mul(hn::Mul(row.part[k], row.part[k]), hn::Set(D(), perSquare)));
  return row;
}

struct Span {
  int low, high;  // both included
};
HWY_INLINE Span spanOf(float rest, float radius) {
  return {splatReachBelow(rest, radius), splatReachAbove(rest, radius)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#endif
