// What small particles give to a tile: each is evaluated once, and scaled by its own sum. Depends on
// splat_kernels.h, splat_rows-inl.h, Highway.
#include "bake/splat_kernels.h"

#include <algorithm>

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

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(intoTile);

void splatIntoTile(SplatKernel kernel, const SplatRecord* records, size_t count, const SplatTile& tile) {
  HWY_DYNAMIC_DISPATCH(intoTile)(kernel, records, count, tile);
}

}  // namespace nephele
#endif
