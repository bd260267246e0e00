// Cellular noise by SIMD. The feature points that can be nearest to any place of a box are gathered once;
// distances to those few are then taken in registers. Depends on worley_kernels.h, Highway, shared text.
#include "bake/fields/worley_kernels.h"

#include "bake/fields/cell_place.h"
#include "bake/fields/shared_text.h"
#include "bake/fields/worley_strewn.h"

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/worley_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef NEPHELE_WORLEY_FEATURES
#define NEPHELE_WORLEY_FEATURES
namespace nephele {

// A box of at most this many cells along an axis needs at most 9³ cells: √3 more on each side.
constexpr double kWidestBox = 4.0;
constexpr int kMostAlong = 9, kMostFeatures = kMostAlong * kMostAlong * kMostAlong;
// From this width on, in cells, points fare better each with cells of its own than with features gathered for
// all; with very few points a vector is not filled.
constexpr float kStrewn = 1.5f;
constexpr size_t kFewPoints = 16;
// The widest vector's bytes. (HWY_ALIGN is that of one target, and these arrays serve all.)
constexpr size_t kVectorBytes = 64;

/// Feature points near a box, in cells relative to a first cell.
struct Features {
  int count = 0;
  alignas(kVectorBytes) float x[kMostFeatures];
  alignas(kVectorBytes) float y[kMostFeatures];
  alignas(kVectorBytes) float z[kMostFeatures];
};

/// The lattice cell that places are relative to, along each axis.
struct FirstCell {
  int32_t x, y, z;
};

}  // namespace nephele
#endif

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Squared distance from a coordinate to the nearest and to the farthest place of [low, high].
HWY_INLINE void axisGaps(float at, float low, float high, float& nearest, float& farthest) {
  const float below = low - at, above = at - high;
  const float gap = below > above ? below : above;
  nearest = gap > 0.0f ? gap * gap : 0.0f;
  const float far = -above > -below ? high - at : at - low;
  farthest = far * far;
}

// The squared distances from [low, high] along one axis to the cells from `first` on.
HWY_INLINE void cellGaps(int first, int last, float low, float high, float* gaps) {
  for (int cell = first; cell <= last; ++cell) {
    const float gap = std::max({0.0f, float(cell) - high, low - float(cell + 1)});
    gaps[cell - first] = gap * gap;
  }
}

// Fills `out` with the feature points that can be among the nearest `rank` (1 or 2) of any place in [low,
// high], in cells relative to `first`.
void gatherFeatures(const WorleyNoise& noise, const FirstCell& first, const glm::vec3& low,
                    const glm::vec3& high, int rank, Features& out) {
  constexpr float kReach = 1.7320509f;  // √3, rounded up
  float nearest[kMostFeatures];
  float least = 1e9f, second = 1e9f;  // of the squared distances to the box's farthest places
  int count = 0;
  const auto take = [&](int x, int y, int z) {
    const glm::ivec3 cell(cellAfter(first.x, float(x)), cellAfter(first.y, float(y)),
                          cellAfter(first.z, float(z)));
    const glm::vec3 place =
        noise.turn.evolves
            ? shared::turnedFeature(cell, noise.jitter, noise.period, noise.seed, noise.turn.at)
            : shared::featurePoint(cell, noise.jitter, noise.period, noise.seed);
    out.x[count] = float(x) + place.x;
    out.y[count] = float(y) + place.y;
    out.z[count] = float(z) + place.z;
    float nearX, nearY, nearZ, farX, farY, farZ;
    axisGaps(out.x[count], low.x, high.x, nearX, farX);
    axisGaps(out.y[count], low.y, high.y, nearY, farY);
    axisGaps(out.z[count], low.z, high.z, nearZ, farZ);
    nearest[count] = nearX + nearY + nearZ;
    const float farthest = farX + farY + farZ;
    second = std::min(second, std::max(least, farthest));
    least = std::min(least, farthest);
    ++count;
  };
  // A part in 10^5 for rounding: one feature too many costs nothing, one too few is wrong.
  const auto limit = [&] { return (rank == 1 ? least : second) * 1.00001f + 1e-6f; };
  const auto floorOf = [](float v) { return int(std::floor(v)); };
  const glm::ivec3 from(floorOf(low.x - kReach), floorOf(low.y - kReach), floorOf(low.z - kReach)),
      to(floorOf(high.x + kReach), floorOf(high.y + kReach), floorOf(high.z + kReach));
  float gapX[kMostAlong], gapY[kMostAlong], gapZ[kMostAlong];
  cellGaps(from.x, to.x, low.x, high.x, gapX);
  cellGaps(from.y, to.y, low.y, high.y, gapY);
  cellGaps(from.z, to.z, low.z, high.z, gapZ);
  // The box's own cells first: what they hold leaves out most of the others, unseen.
  for (const bool own : {true, false})
    for (int x = from.x; x <= to.x; ++x)
      for (int y = from.y; y <= to.y; ++y)
        for (int z = from.z; z <= to.z; ++z) {
          const float gap = gapX[x - from.x] + gapY[y - from.y] + gapZ[z - from.z];
          if ((gap == 0.0f) == own && gap <= limit()) take(x, y, z);
        }
  const float farthest = limit();
  const int taken = count;
  count = 0;
  for (int n = 0; n < taken; ++n) {
    if (nearest[n] > farthest) continue;
    out.x[count] = out.x[n];
    out.y[count] = out.y[n];
    out.z[count] = out.z[n];
    ++count;
  }
  out.count = count;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V distanceOf(D, V first, V second, WorleyOutput output) {
  if (output == WorleyOutput::f1) return hn::Sqrt(first);
  if (output == WorleyOutput::f2) return hn::Sqrt(second);
  return hn::Sub(hn::Sqrt(second), hn::Sqrt(first));
}

// One block: x, y, z are the places of its 8 planes along each axis.
void worleyRows(const Features& features, WorleyOutput output, const float* x, const float* y, const float* z,
                float* values) {
  const hn::CappedTag<float, kBlockEdge> d;
  const size_t lanes = hn::Lanes(d);
  const auto far = hn::Set(d, 9.0f);  // squared; above 3
  for (int i = 0; i < kBlockEdge; ++i) {
    // Squared distances across z for each feature of this plane: (x − fx)² + (y − fy)² in the order of the
    // definition.
    for (int j = 0; j < kBlockEdge; ++j)
      for (size_t k = 0; k < size_t(kBlockEdge); k += lanes) {
        const auto vz = hn::LoadU(d, z + k);
        auto first = far, second = far;
        for (int n = 0; n < features.count; ++n) {
          const float dx = features.x[n] - x[i], dy = features.y[n] - y[j];
          const auto dz = hn::Sub(hn::Set(d, features.z[n]), vz);
          const auto squared = hn::Add(hn::Set(d, dx * dx + dy * dy), hn::Mul(dz, dz));
          if (output != WorleyOutput::f1) second = hn::Min(second, hn::Max(first, squared));
          first = hn::Min(first, squared);
        }
        hn::StoreU(distanceOf(d, first, second, output), d, values + i * 64 + j * 8 + int(k));
      }
  }
}

// Points given as places relative to the features' first cell.
void worleyPlaces(const Features& features, WorleyOutput output, const float* x, const float* y,
                  const float* z, size_t count, float* values) {
  const hn::CappedTag<float, 16> d;
  const size_t lanes = hn::Lanes(d);
  const auto far = hn::Set(d, 9.0f);
  // The arrays are padded to a whole vector; what lies beyond `count` is not used.
  for (size_t n = 0; n < count; n += lanes) {
    const auto vx = hn::Load(d, x + n), vy = hn::Load(d, y + n), vz = hn::Load(d, z + n);
    auto first = far, second = far;
    for (int f = 0; f < features.count; ++f) {
      const auto dx = hn::Sub(hn::Set(d, features.x[f]), vx), dy = hn::Sub(hn::Set(d, features.y[f]), vy),
                 dz = hn::Sub(hn::Set(d, features.z[f]), vz);
      const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      if (output != WorleyOutput::f1) second = hn::Min(second, hn::Max(first, squared));
      first = hn::Min(first, squared);
    }
    HWY_ALIGN float lane[16];
    hn::Store(distanceOf(d, first, second, output), d, lane);
    for (size_t k = 0; k < lanes && n + k < count; ++k) values[n + k] = lane[k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(gatherFeatures);
HWY_EXPORT(worleyRows);
HWY_EXPORT(worleyPlaces);

namespace {

int rankOf(WorleyOutput output) { return output == WorleyOutput::f1 ? 1 : 2; }

constexpr size_t kPadding = 16;  // floats of the widest vector

/// Places in cells relative to the first cell, padded for whole vectors.
struct Places {
  alignas(kVectorBytes) float x[kBlockPoints + kPadding];
  alignas(kVectorBytes) float y[kBlockPoints + kPadding];
  alignas(kVectorBytes) float z[kBlockPoints + kPadding];
};

/// to[n] = fraction + from[n] · frequency along one axis, then 15 times the last; [low, high] holds them all.
void placeAlong(const float* from, size_t count, float fraction, float frequency, float* to, float& low,
                float& high) {
  for (size_t n = 0; n < count; ++n) to[n] = fraction + from[n] * frequency;
  std::fill_n(to + count, kPadding, to[count - 1]);
  // Lanes of their own, which compilers turn into vectors.
  float least[kPadding], most[kPadding];
  std::copy_n(to, kPadding, least);
  std::copy_n(to, kPadding, most);
  for (size_t n = 0; n < count; n += kPadding)
    for (size_t lane = 0; lane < kPadding; ++lane) {
      const float v = to[n + lane];
      least[lane] = v < least[lane] ? v : least[lane];
      most[lane] = v > most[lane] ? v : most[lane];
    }
  low = *std::min_element(least, least + kPadding);
  high = *std::max_element(most, most + kPadding);
}

/// The definition at the place f in a cell.
float valueInCell(const WorleyNoise& noise, const glm::ivec3& cell, const glm::vec3& f) {
  const glm::vec2 both = shared::movingDistances(cell, f, noise.jitter, noise.period, noise.seed,
                                                 noise.turn.evolves, noise.turn.at);
  return noise.output == WorleyOutput::f1   ? both.x
         : noise.output == WorleyOutput::f2 ? both.y
                                            : both.y - both.x;
}

}  // namespace

void worleyOnLattice(const WorleyNoise& noise, const Lattice& lattice, float* values) {
  // 7 steps of up to 4/7 cell stay within the widest box.
  if (7.0 * lattice.spacing > kWidestBox * noise.cellSize) {
    worleyAtPoints(noise, LatticePoints(lattice).points(), values);
    return;
  }
  const CellPlace px = cellPlace(lattice.origin.x, noise.cellSize),
                  py = cellPlace(lattice.origin.y, noise.cellSize),
                  pz = cellPlace(lattice.origin.z, noise.cellSize);
  const float step = float(lattice.spacing / noise.cellSize);
  float x[kBlockEdge], y[kBlockEdge], z[kBlockEdge];
  for (int n = 0; n < kBlockEdge; ++n) {
    x[n] = px.fraction + float(n) * step;
    y[n] = py.fraction + float(n) * step;
    z[n] = pz.fraction + float(n) * step;
  }
  Features features;
  HWY_DYNAMIC_DISPATCH(gatherFeatures)
  (noise, {px.cell, py.cell, pz.cell}, {x[0], y[0], z[0]}, {x[7], y[7], z[7]}, rankOf(noise.output),
   features);
  HWY_DYNAMIC_DISPATCH(worleyRows)(features, noise.output, x, y, z, values);
}

void worleyAtPoints(const WorleyNoise& noise, const Points& points, float* values) {
  if (points.count == 0) return;
  const CellPlace px = cellPlace(points.origin.x, noise.cellSize),
                  py = cellPlace(points.origin.y, noise.cellSize),
                  pz = cellPlace(points.origin.z, noise.cellSize);
  const float frequency = float(1.0 / noise.cellSize);
  Places places;
  glm::vec3 low, high;
  placeAlong(points.x, points.count, px.fraction, frequency, places.x, low.x, high.x);
  placeAlong(points.y, points.count, py.fraction, frequency, places.y, low.y, high.y);
  placeAlong(points.z, points.count, pz.fraction, frequency, places.z, low.z, high.z);
  const glm::vec3 size = high - low;
  const float widest = std::max({size.x, size.y, size.z});
  const bool gathered = widest <= float(kWidestBox);
  // Points strewn over many cells, as under a wild warp: each looks round by itself.
  const bool plain = noise.period == 0 && !noise.turn.evolves;
  if (plain && widest > kStrewn && points.count >= kFewPoints &&
      worleyStrewn(noise, {px.cell, py.cell, pz.cell, places.x, places.y, places.z},
                   gathered ? Frame::firstCell : Frame::ownCell, points.count, values))
    return;
  if (gathered) {
    Features features;
    HWY_DYNAMIC_DISPATCH(gatherFeatures)
    (noise, {px.cell, py.cell, pz.cell}, low, high, rankOf(noise.output), features);
    HWY_DYNAMIC_DISPATCH(worleyPlaces)
    (features, noise.output, places.x, places.y, places.z, points.count, values);
    return;
  }
  for (size_t n = 0; n < points.count; ++n) {
    const glm::vec3 whole(std::floor(places.x[n]), std::floor(places.y[n]), std::floor(places.z[n]));
    const glm::ivec3 cell(cellAfter(px.cell, whole.x), cellAfter(py.cell, whole.y),
                          cellAfter(pz.cell, whole.z));
    const glm::vec3 f = glm::vec3(places.x[n], places.y[n], places.z[n]) - whole;
    values[n] = valueInCell(noise, cell, f);
  }
}

float worleyAt(const WorleyNoise& noise, const glm::dvec3& p) {
  const CellPlace x = cellPlace(p.x, noise.cellSize), y = cellPlace(p.y, noise.cellSize),
                  z = cellPlace(p.z, noise.cellSize);
  return valueInCell(noise, {x.cell, y.cell, z.cell}, {x.fraction, y.fraction, z.fraction});
}

}  // namespace nephele
#endif
