// Splat kernels in rows of 8 voxels. Depends on splat_kernels.h, Highway.
#include "bake/splat_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/splat_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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
HWY_INLINE V exponentialOf(V x) {
  const D d;
  const auto k = hn::Floor(hn::Add(hn::Mul(x, hn::Set(d, 1.44269504f)), hn::Set(d, 0.5f)));
  const auto r =
      hn::Sub(hn::Sub(x, hn::Mul(k, hn::Set(d, 0.693359375f))), hn::Mul(k, hn::Set(d, -2.12194440e-4f)));
  auto series = hn::Add(hn::Set(d, 1.0f / 720.0f), hn::Mul(r, hn::Set(d, 1.0f / 5040.0f)));
  for (const float term : {1.0f / 120.0f, 1.0f / 24.0f, 1.0f / 6.0f, 0.5f})
    series = hn::Add(hn::Set(d, term), hn::Mul(r, series));
  const auto power = hn::Add(hn::Set(d, 1.0f), hn::Add(r, hn::Mul(hn::Mul(r, r), series)));
  const hn::RebindToSigned<D> di;
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, k), hn::Set(di, 127)));
  return hn::Mul(power, hn::BitCast(d, exponent));
}

// The Gaussian ends at three standard deviations.
constexpr float kGaussianRate = 4.5f;

/// A kernel of the squared distance in radii; 0 from 1 on.
struct Wendland {
  static constexpr SplatKernel kName = SplatKernel::wendland;
  /// (1 − q)⁴ (4q + 1) [Wendland 1995, C2].
  static HWY_INLINE V at(V squared) {
    const D d;
    const auto q = hn::Sqrt(squared);
    const auto t = hn::Max(hn::Sub(hn::Set(d, 1.0f), q), hn::Zero(d));
    const auto t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(t2, t2), hn::Add(hn::Mul(q, hn::Set(d, 4.0f)), hn::Set(d, 1.0f)));
  }
};
struct SmoothSphere {
  static constexpr SplatKernel kName = SplatKernel::smoothSphere;
  /// 1 up to half the radius, then s² (3 − 2s), s = (1 − q²)/(3/4).
  static HWY_INLINE V at(V squared) {
    const D d;
    const auto one = hn::Set(d, 1.0f);
    const auto s =
        hn::Min(hn::Max(hn::Mul(hn::Sub(one, squared), hn::Set(d, 4.0f / 3.0f)), hn::Zero(d)), one);
    return hn::Mul(hn::Mul(s, s), hn::Sub(hn::Set(d, 3.0f), hn::Add(s, s)));
  }
};
struct Gaussian {
  static constexpr SplatKernel kName = SplatKernel::gaussian;
  static HWY_INLINE V at(V squared) {
    const D d;
    const auto nearer = hn::Min(squared, hn::Set(d, 1.0f));
    const auto value = exponentialOf(hn::Mul(nearer, hn::Set(d, -kGaussianRate)));
    return hn::IfThenElseZero(hn::Lt(squared, hn::Set(d, 1.0f)), value);
  }
};

/// The Gaussian's factor of one axis: it ends on the faces of a cube.
HWY_INLINE Row gaussianFactors(int first, float rest, float perSquare) {
  Row row = apartFrom(first, rest);
  for (size_t k = 0; k < kParts; ++k)
    row.part[k] = Gaussian::at(hn::Mul(hn::Mul(row.part[k], row.part[k]), hn::Set(D(), perSquare)));
  return row;
}

struct Span {
  int low, high;  // both included
};
HWY_INLINE Span spanOf(float rest, float radius) {
  return {splatReachBelow(rest, radius), splatReachAbove(rest, radius)};
}

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
          plane.part[k] = hn::Add(plane.part[k], Kernel::at(hn::Add(dz.part[k], hn::Set(D(), aside))));
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
        row.part[k] = hn::Mul(Kernel::at(hn::Add(dz.part[k], hn::Set(D(), aside))), scale);
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
        if (field) {
          const auto eaten = hn::Mul(hn::Max(hn::LoadU(d, field + offset + k * kLanes), hn::Zero(d)),
                                     hn::Set(d, shape.erosion));
          const auto q = hn::Add(hn::Sqrt(squared), eaten);
          squared = hn::Mul(q, q);
        }
        const auto weight = Kernel::at(squared);
        hn::StoreU(weight, d, weights + offset + k * kLanes);
        plane.part[k] = hn::Add(plane.part[k], weight);
      }
    }
    sum += sumOf(plane);
  }
  return sum;
}

/// The part of a particle's rows that lies in a tile.
struct TileClip {
  Span x, y;    // relative to the cell, inside the tile
  int zOffset;  // of the first voxel of a row, from the row's begin with its room

  HWY_INLINE TileClip(const SplatRecord& p, const Span& wholeX, const Span& wholeY, int zLow) {
    x = clipped(wholeX, p.cell[0]);
    y = clipped(wholeY, p.cell[1]);
    zOffset = SplatTile::kBefore + p.cell[2] + zLow;
  }
  static HWY_INLINE Span clipped(const Span& span, int cell) {
    const int low = -cell, high = SplatTile::kEdge - 1 - cell;
    return {span.low > low ? span.low : low, span.high < high ? span.high : high};
  }
};

HWY_INLINE void touch(const SplatRecord& p, const TileClip& clip, const Span& z, const SplatTile& tile) {
  const Span inside = TileClip::clipped(z, p.cell[2]);
  constexpr int kShift = 3;  // 8 voxels
  for (int x = (p.cell[0] + clip.x.low) >> kShift; x <= (p.cell[0] + clip.x.high) >> kShift; ++x)
    for (int y = (p.cell[1] + clip.y.low) >> kShift; y <= (p.cell[1] + clip.y.high) >> kShift; ++y)
      for (int at = (p.cell[2] + inside.low) >> kShift; at <= (p.cell[2] + inside.high) >> kShift; ++at)
        tile.touched[(x * SplatTile::kLeaves + y) * SplatTile::kLeaves + at] = 1;
}

HWY_INLINE float* tileRow(const SplatRecord& p, const TileClip& clip, int x, int y, const SplatTile& tile) {
  return tile.values + ((p.cell[0] + x) * SplatTile::kEdge + p.cell[1] + y) * SplatTile::kPitch +
         clip.zOffset;
}

HWY_INLINE void addScaled(const Row& row, V scale, float* to) {
  for (size_t k = 0; k < kParts; ++k) {
    float* const at = to + k * kLanes;
    hn::StoreU(hn::Add(hn::LoadU(D(), at), hn::Mul(row.part[k], scale)), D(), at);
  }
}

constexpr int kWidestSpan = 9;

/// Evaluates a radial kernel once, on kRows rows of 8 along z, and adds it scaled by its own sum.
template <class Kernel, int kRows>
HWY_INLINE void radialIntoTile(const SplatRecord& p, const SplatTile& tile) {
  const D d;
  const float perSquare = 1.0f / (p.radius * p.radius);
  const Span x = spanOf(p.rest[0], p.radius), y = spanOf(p.rest[1], p.radius),
             z = spanOf(p.rest[2], p.radius);
  Row dz[kRows];
  for (int r = 0; r < kRows; ++r) {
    dz[r] = apartFrom(z.low + r * kLeafEdge, p.rest[2]);
    for (size_t k = 0; k < kParts; ++k)
      dz[r].part[k] = hn::Mul(hn::Mul(dz[r].part[k], dz[r].part[k]), hn::Set(d, perSquare));
  }
  float aside[kWidestSpan * kWidestSpan];
  Row rows[kWidestSpan * kWidestSpan * kRows];
  int count = 0;
  Row total = allEqual(0.0f);
  for (int xAt = x.low; xAt <= x.high; ++xAt) {
    const float dx = float(xAt) - p.rest[0], dx2 = dx * dx * perSquare;
    for (int yAt = y.low; yAt <= y.high; ++yAt, ++count) {
      const float dy = float(yAt) - p.rest[1];
      aside[count] = dx2 + dy * dy * perSquare;
      if (aside[count] >= 1.0f) continue;
      const auto both = hn::Set(d, aside[count]);
      for (int r = 0; r < kRows; ++r)
        for (size_t k = 0; k < kParts; ++k) {
          const auto value = Kernel::at(hn::Add(dz[r].part[k], both));
          rows[count * kRows + r].part[k] = value;
          total.part[k] = hn::Add(total.part[k], value);
        }
    }
  }
  const auto scale = hn::Set(d, float(double(p.scale) / sumOf(total)));
  const TileClip clip(p, x, y, z.low);
  touch(p, clip, z, tile);
  for (int xAt = clip.x.low; xAt <= clip.x.high; ++xAt)
    for (int yAt = clip.y.low; yAt <= clip.y.high; ++yAt) {
      const int n = (xAt - x.low) * (y.high - y.low + 1) + yAt - y.low;
      if (aside[n] >= 1.0f) continue;
      float* const to = tileRow(p, clip, xAt, yAt, tile);
      for (int r = 0; r < kRows; ++r) addScaled(rows[n * kRows + r], scale, to + r * kLeafEdge);
    }
}

// Four voxels along z, of which two rows fill a Row.
constexpr int kShortEdge = 4;
using DShort = hn::CappedTag<float, kShortEdge>;
constexpr size_t kShortLanes = hn::MaxLanes(DShort());

HWY_INLINE void addShort(const float* values, float scale, float* to) {
  const DShort d;
  for (size_t k = 0; k < kShortEdge; k += kShortLanes) {
    const auto given = hn::Mul(hn::LoadU(d, values + k), hn::Set(d, scale));
    hn::StoreU(hn::Add(hn::LoadU(d, to + k), given), d, to + k);
  }
}

/// The same for a particle of at most four voxels along each axis: two rows at a time.
template <class Kernel>
HWY_INLINE void shortIntoTile(const SplatRecord& p, const SplatTile& tile) {
  const D d;
  const float perSquare = 1.0f / (p.radius * p.radius);
  const Span x = spanOf(p.rest[0], p.radius), y = spanOf(p.rest[1], p.radius),
             z = spanOf(p.rest[2], p.radius);
  // Squared distances in radii; voxels that are not reached lie at 1, where every kernel is 0.
  alignas(64) float dy2[kShortEdge], dz2[kLeafEdge];
  for (int n = 0; n < kShortEdge; ++n) {
    const float dy = float(y.low + n) - p.rest[1], dz = float(z.low + n) - p.rest[2];
    dy2[n] = y.low + n <= y.high ? dy * dy * perSquare : 1.0f;
    dz2[n] = dz2[n + kShortEdge] = z.low + n <= z.high ? dz * dz * perSquare : 1.0f;
  }
  const Row dz = loaded(dz2);
  Row pairs[2];  // of neighbours along y
  for (int n = 0; n < 2; ++n) {
    alignas(64) float both[kLeafEdge];
    for (int k = 0; k < kLeafEdge; ++k) both[k] = dy2[2 * n + k / kShortEdge];
    pairs[n] = loaded(both);
    for (size_t k = 0; k < kParts; ++k) pairs[n].part[k] = hn::Add(pairs[n].part[k], dz.part[k]);
  }
  alignas(64) float values[kShortEdge][kShortEdge][kShortEdge];
  Row total = allEqual(0.0f);
  for (int n = 0; n <= x.high - x.low; ++n) {
    const float dx = float(x.low + n) - p.rest[0];
    const auto aside = hn::Set(d, dx * dx * perSquare);
    for (int pair = 0; pair < 2; ++pair)
      for (size_t k = 0; k < kParts; ++k) {
        const auto value = Kernel::at(hn::Add(pairs[pair].part[k], aside));
        hn::StoreU(value, d, values[n][2 * pair] + k * kLanes);
        total.part[k] = hn::Add(total.part[k], value);
      }
  }
  const float scale = float(double(p.scale) / sumOf(total));
  const TileClip clip(p, x, y, z.low);
  touch(p, clip, z, tile);
  for (int xAt = clip.x.low; xAt <= clip.x.high; ++xAt)
    for (int yAt = clip.y.low; yAt <= clip.y.high; ++yAt)
      addShort(values[xAt - x.low][yAt - y.low], scale, tileRow(p, clip, xAt, yAt, tile));
}

/// Whether no axis reaches over more than four voxels.
HWY_INLINE bool isShort(const SplatRecord& p) {
  constexpr float kSurely = 1.5f;  // 2r + 1 = 4
  if (p.radius < kSurely) return true;
  if (p.radius > 2.0f) return false;
  for (const float rest : p.rest) {
    const Span span = spanOf(rest, p.radius);
    if (span.high - span.low >= kShortEdge) return false;
  }
  return true;
}

template <int kRows>
HWY_INLINE void gaussianIntoTile(const SplatRecord& p, const SplatTile& tile) {
  const float perSquare = 1.0f / (p.radius * p.radius);
  const Span span[] = {spanOf(p.rest[0], p.radius), spanOf(p.rest[1], p.radius), spanOf(p.rest[2], p.radius)};
  alignas(64) float factors[2][kRows * kLeafEdge];
  Row ez[kRows];
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0.0;
    for (int r = 0; r < kRows; ++r) {
      const Row row = gaussianFactors(span[axis].low + r * kLeafEdge, p.rest[axis], perSquare);
      sum += sumOf(row);
      if (axis < 2)
        stored(row, factors[axis] + r * kLeafEdge);
      else
        ez[r] = row;
    }
    product *= sum;
  }
  const float scale = float(double(p.scale) / product);
  const TileClip clip(p, span[0], span[1], span[2].low);
  touch(p, clip, span[2], tile);
  for (int x = clip.x.low; x <= clip.x.high; ++x) {
    const float along = factors[0][x - span[0].low] * scale;
    for (int y = clip.y.low; y <= clip.y.high; ++y) {
      const auto aside = hn::Set(D(), along * factors[1][y - span[1].low]);
      float* const to = tileRow(p, clip, x, y, tile);
      for (int r = 0; r < kRows; ++r) addScaled(ez[r], aside, to + r * kLeafEdge);
    }
  }
}

/// The Gaussian of a particle of at most four voxels along each axis.
HWY_INLINE void shortGaussianIntoTile(const SplatRecord& p, const SplatTile& tile) {
  const float perSquare = 1.0f / (p.radius * p.radius);
  Span span[3];
  // Four factors an axis; the fourth axis fills the row.
  alignas(64) float factors[2 * kLeafEdge];
  for (int axis = 0; axis < 3; ++axis) {
    span[axis] = spanOf(p.rest[axis], p.radius);
    for (int n = 0; n < kShortEdge; ++n) {
      const float apart = float(span[axis].low + n) - p.rest[axis];
      factors[axis * kShortEdge + n] =
          span[axis].low + n <= span[axis].high ? apart * apart * perSquare : 1.0f;
    }
  }
  std::fill_n(factors + 3 * kShortEdge, kShortEdge, 1.0f);
  for (size_t at = 0; at < 2 * kLeafEdge; at += kLanes)
    hn::StoreU(Gaussian::at(hn::LoadU(D(), factors + at)), D(), factors + at);
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const float* const f = factors + axis * kShortEdge;
    product *= (double(f[0]) + double(f[1])) + (double(f[2]) + double(f[3]));
  }
  const float scale = float(double(p.scale) / product);
  const TileClip clip(p, span[0], span[1], span[2].low);
  touch(p, clip, span[2], tile);
  for (int x = clip.x.low; x <= clip.x.high; ++x) {
    const float along = factors[x - span[0].low] * scale;
    for (int y = clip.y.low; y <= clip.y.high; ++y)
      addShort(factors + 2 * kShortEdge, along * factors[kShortEdge + y - span[1].low],
               tileRow(p, clip, x, y, tile));
  }
}

template <int kRows>
HWY_INLINE void oneIntoTile(SplatKernel kernel, const SplatRecord& p, const SplatTile& tile) {
  if (kernel == SplatKernel::gaussian)
    gaussianIntoTile<kRows>(p, tile);
  else if (kernel == SplatKernel::wendland)
    radialIntoTile<Wendland, kRows>(p, tile);
  else
    radialIntoTile<SmoothSphere, kRows>(p, tile);
}

HWY_INLINE void oneShortIntoTile(SplatKernel kernel, const SplatRecord& p, const SplatTile& tile) {
  if (kernel == SplatKernel::gaussian)
    shortGaussianIntoTile(p, tile);
  else if (kernel == SplatKernel::wendland)
    shortIntoTile<Wendland>(p, tile);
  else
    shortIntoTile<SmoothSphere>(p, tile);
}

void intoTile(SplatKernel kernel, const SplatRecord* records, size_t count, const SplatTile& tile) {
  // Up to this radius a particle reaches over 8 voxels at most.
  constexpr float kOneRow = 3.5f;
  for (size_t n = 0; n < count; ++n)
    if (isShort(records[n]))
      oneShortIntoTile(kernel, records[n], tile);
    else if (records[n].radius <= kOneRow)
      oneIntoTile<1>(kernel, records[n], tile);
    else
      oneIntoTile<2>(kernel, records[n], tile);
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
HWY_EXPORT(losses);
HWY_EXPORT(intoTile);

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

void splatIntoTile(SplatKernel kernel, const SplatRecord* records, size_t count, const SplatTile& tile) {
  HWY_DYNAMIC_DISPATCH(intoTile)(kernel, records, count, tile);
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
