// What small particles give to a tile: each is evaluated once, and scaled by its own sum. Depends on
// splat_kernels.h, splat_rows-inl.h, Highway.
#include "bake/splat_kernels.h"

#include <algorithm>
#include <type_traits>

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/splat_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/splat_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
          const auto value = Kernel::at(d, hn::Add(dz[r].part[k], both));
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

// Four voxels along each axis: a plane of them is one vector where vectors are that long.
constexpr int kShortEdge = 4;
constexpr size_t kPlane = size_t(kShortEdge) * kShortEdge;
using DPlane = hn::CappedTag<float, kPlane>;
constexpr size_t kPlaneLanes = hn::MaxLanes(DPlane());
using DShort = hn::CappedTag<float, kShortEdge>;
constexpr size_t kShortLanes = hn::MaxLanes(DShort());

/// What a particle of at most four voxels along each axis gives to them, [x][y][z].
struct ShortCube {
  alignas(64) float values[kShortEdge][kPlane];
};

/// The voxels that a particle reaches along each axis, relative to its cell.
struct Reach {
  Span axis[3];

  explicit HWY_INLINE Reach(const SplatRecord& p) {
    for (int n = 0; n < 3; ++n) axis[n] = spanOf(p.rest[n], p.radius);
  }
  /// Whether no axis reaches over more than four voxels.
  HWY_INLINE bool isShort() const {
    return axis[0].high - axis[0].low < kShortEdge && axis[1].high - axis[1].low < kShortEdge &&
           axis[2].high - axis[2].low < kShortEdge;
  }
};

/// Squared distances in radii along an axis; voxels that are not reached lie at 1, where every kernel is 0.
HWY_INLINE void shortSquares(const Span& span, float rest, float perSquare, float* squares) {
  for (int n = 0; n < kShortEdge; ++n) {
    const float apart = float(span.low + n) - rest;
    squares[n] = span.low + n <= span.high ? apart * apart * perSquare : 1.0f;
  }
}

/// Σ of a plane, folded in halves, so that it is the same on every target. The values are lost.
HWY_INLINE float folded(float* values) {
  for (size_t half = kPlane / 2; half > 0; half /= 2)
    for (size_t n = 0; n < half; ++n) values[n] += values[n + half];
  return values[0];
}

template <class Kernel>
HWY_INLINE void shortWeights(const SplatRecord& p, const Reach& reach, ShortCube& cube) {
  const DPlane d;
  const float perSquare = 1.0f / (p.radius * p.radius);
  float squares[3][kShortEdge];
  for (int axis = 0; axis < 3; ++axis) shortSquares(reach.axis[axis], p.rest[axis], perSquare, squares[axis]);
  alignas(64) float plane[kPlane], total[kPlane];
  for (size_t n = 0; n < kPlane; ++n) plane[n] = squares[1][n / kShortEdge] + squares[2][n % kShortEdge];
  hn::Vec<DPlane> values[kShortEdge][kPlane / kPlaneLanes];
  for (size_t k = 0; k < kPlane / kPlaneLanes; ++k) {
    const auto aside = hn::Load(d, plane + k * kPlaneLanes);
    for (int x = 0; x < kShortEdge; ++x)
      values[x][k] = Kernel::at(d, hn::Add(aside, hn::Set(d, squares[0][x])));
    hn::Store(hn::Add(hn::Add(values[0][k], values[1][k]), hn::Add(values[2][k], values[3][k])), d,
              total + k * kPlaneLanes);
  }
  const auto scale = hn::Set(d, p.scale / folded(total));
  for (int x = 0; x < kShortEdge; ++x)
    for (size_t k = 0; k < kPlane / kPlaneLanes; ++k)
      hn::Store(hn::Mul(values[x][k], scale), d, cube.values[x] + k * kPlaneLanes);
}

/// The Gaussian is a product of one factor an axis.
template <>
HWY_INLINE void shortWeights<Gaussian>(const SplatRecord& p, const Reach& reach, ShortCube& cube) {
  const DPlane d;
  const float perSquare = 1.0f / (p.radius * p.radius);
  alignas(64) float factors[kPlane];  // of three axes, then 1
  for (int axis = 0; axis < 3; ++axis)
    shortSquares(reach.axis[axis], p.rest[axis], perSquare, factors + axis * kShortEdge);
  std::fill_n(factors + 3 * kShortEdge, kShortEdge, 1.0f);
  for (size_t at = 0; at < kPlane; at += kPlaneLanes)
    hn::Store(Gaussian::at(d, hn::Load(d, factors + at)), d, factors + at);
  float product = 1.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float* const f = factors + axis * kShortEdge;
    product *= (f[0] + f[1]) + (f[2] + f[3]);
  }
  const float scale = p.scale / product;
  alignas(64) float plane[kPlane];
  for (size_t n = 0; n < kPlane; ++n)
    plane[n] = factors[kShortEdge + n / kShortEdge] * factors[2 * kShortEdge + n % kShortEdge];
  for (int x = 0; x < kShortEdge; ++x) {
    const auto along = hn::Set(d, factors[x] * scale);
    for (size_t k = 0; k < kPlane; k += kPlaneLanes)
      hn::Store(hn::Mul(hn::Load(d, plane + k), along), d, cube.values[x] + k);
  }
}

HWY_INLINE void addShort(const float* values, float* to) {
  const DShort d;
  for (size_t k = 0; k < kShortEdge; k += kShortLanes)
    hn::StoreU(hn::Add(hn::LoadU(d, to + k), hn::Load(d, values + k)), d, to + k);
}

HWY_INLINE void addCube(const SplatRecord& p, const Reach& reach, const ShortCube& cube,
                        const SplatTile& tile) {
  constexpr int kLast = SplatTile::kEdge - 1, kShift = 3;  // leaves of 8 voxels
  int first[3];
  for (int axis = 0; axis < 3; ++axis) first[axis] = p.cell[axis] + reach.axis[axis].low;
  float* const corner = tile.values + (first[0] * SplatTile::kEdge + first[1]) * SplatTile::kPitch +
                        SplatTile::kBefore + first[2];
  int low[3], high[3];
  bool within = true;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(first[axis], 0);
    high[axis] = std::min(p.cell[axis] + reach.axis[axis].high, kLast);
    if (low[axis] > high[axis]) return;
    within = within && (axis == 2 || (first[axis] >= 0 && first[axis] + kShortEdge - 1 <= kLast));
  }
  // At most two leaves along each axis.
  for (const int x : {low[0] >> kShift, high[0] >> kShift})
    for (const int y : {low[1] >> kShift, high[1] >> kShift})
      for (const int z : {low[2] >> kShift, high[2] >> kShift})
        tile.touched[(x * SplatTile::kLeaves + y) * SplatTile::kLeaves + z] = 1;
  if (within) {
    for (int x = 0; x < kShortEdge; ++x)
      for (int y = 0; y < kShortEdge; ++y)
        addShort(cube.values[x] + y * kShortEdge, corner + (x * SplatTile::kEdge + y) * SplatTile::kPitch);
    return;
  }
  for (int x = low[0] - first[0]; x <= high[0] - first[0]; ++x)
    for (int y = low[1] - first[1]; y <= high[1] - first[1]; ++y)
      addShort(cube.values[x] + y * kShortEdge, corner + (x * SplatTile::kEdge + y) * SplatTile::kPitch);
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

template <class Kernel>
void intoTileWith(const SplatRecord* records, const uint32_t* order, size_t count, const SplatTile& tile) {
  // Up to this radius a particle reaches over 8 voxels at most.
  constexpr float kOneRow = 3.5f;
  constexpr bool kSeparable = std::is_same_v<Kernel, Gaussian>;
  for (size_t n = 0; n < count; ++n) {
    const SplatRecord& p = records[order[n]];
    const Reach reach(p);
    if (reach.isShort()) {
      ShortCube cube;
      shortWeights<Kernel>(p, reach, cube);
      addCube(p, reach, cube, tile);
    } else if (p.radius <= kOneRow) {
      if constexpr (kSeparable)
        gaussianIntoTile<1>(p, tile);
      else
        radialIntoTile<Kernel, 1>(p, tile);
    } else {
      if constexpr (kSeparable)
        gaussianIntoTile<2>(p, tile);
      else
        radialIntoTile<Kernel, 2>(p, tile);
    }
  }
}

void intoTile(SplatKernel kernel, const SplatRecord* records, const uint32_t* order, size_t count,
              const SplatTile& tile) {
  if (kernel == SplatKernel::gaussian)
    intoTileWith<Gaussian>(records, order, count, tile);
  else if (kernel == SplatKernel::wendland)
    intoTileWith<Wendland>(records, order, count, tile);
  else
    intoTileWith<SmoothSphere>(records, order, count, tile);
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(intoTile);

void splatIntoTile(SplatKernel kernel, const SplatRecord* records, const uint32_t* order, size_t count,
                   const SplatTile& tile) {
  HWY_DYNAMIC_DISPATCH(intoTile)(kernel, records, order, count, tile);
}

}  // namespace nephele
#endif
