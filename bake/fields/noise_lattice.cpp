// Gradient noise on lattice blocks by SIMD. The lattice corners of a block are gathered once; gradients are
// mixed over x and y in vectors whose lanes are the corners along z, and a permutation hands each voxel of a
// row its two corners. Depends on perlin.h, Highway.
#include "bake/fields/cell_place.h"
#include "bake/fields/noise_gradients.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/shared_text.h"

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/noise_lattice.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/fields/noise_vectors.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

// One axis of a block: the cell of each of its 8 planes relative to the first, the place in it, and the fade
// weight.
struct BlockAxis {
  HWY_ALIGN float place[kBlockEdge];
  HWY_ALIGN float weight[kBlockEdge];
  HWY_ALIGN int32_t cell[kBlockEdge];
  int32_t first = 0;  // lattice cell of plane 0
  int corners = 0;    // lattice planes that the block needs
};

HWY_INLINE void setAxis(double origin, double cellSize, float step, BlockAxis& axis) {
  const hn::CappedTag<float, kBlockEdge> d;
  const hn::RebindToSigned<decltype(d)> di;
  const CellPlace start = cellPlace(origin, cellSize);
  axis.first = start.cell;
  for (size_t n = 0; n < size_t(kBlockEdge); n += hn::Lanes(d)) {
    const auto along = hn::Add(hn::Set(d, start.fraction), hn::Mul(hn::Iota(d, float(n)), hn::Set(d, step)));
    const auto whole = hn::Floor(along);
    const auto place = hn::Sub(along, whole);
    hn::Store(place, d, axis.place + n);
    hn::Store(fade(d, place), d, axis.weight + n);
    hn::Store(hn::ConvertTo(di, whole), di, axis.cell + n);
  }
  // A fraction that rounds to 1 starts in the next cell.
  const int32_t base = axis.cell[0];
  if (base != 0) {
    axis.first = cellAfter(axis.first, float(base));
    for (int32_t& cell : axis.cell) cell -= base;
  }
  axis.corners = axis.cell[kBlockEdge - 1] + 2;
}

// Eight planes whose step is at most half a cell need at most 6 corners along x and y; along z a vector holds
// as many corners as it has lanes, 4 for half a row or 8 for a whole one.
constexpr int kMostCorners = 6;
// Rows along z are worked on in vectors of 4 (half a row), 8 (a row) or 16 (the same row of two neighbouring
// x planes).
constexpr size_t kLanes = HWY_MAX_BYTES / sizeof(float) < 16 ? HWY_MAX_BYTES / sizeof(float) : 16;
constexpr size_t kRowLanes = kLanes < 8 ? kLanes : 8;
constexpr size_t kGroups = 8 / kRowLanes;
constexpr size_t kPlanes = kLanes / kRowLanes;

// The gradients at the block's lattice corners, weighted by the octave: [x][y][lane along z].
struct Corners {
  HWY_ALIGN float x[kMostCorners][kMostCorners][kRowLanes];
  HWY_ALIGN float y[kMostCorners][kMostCorners][kRowLanes];
  HWY_ALIGN float z[kMostCorners][kMostCorners][kRowLanes];
};

HWY_INLINE void gather(const NoiseOctave& octave, const BlockAxis& ax, const BlockAxis& ay, int32_t firstZ,
                       Corners& out) {
  const hn::CappedTag<float, kRowLanes> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  HWY_ALIGN uint32_t alongZ[kRowLanes];
  for (size_t k = 0; k < kRowLanes; ++k)
    alongZ[k] = uint32_t(shared::foldCell(int32_t(uint32_t(firstZ) + uint32_t(k)), octave.period)) * kHashZ;
  const auto hz = hn::Xor(hn::Load(du, alongZ), hn::Set(du, octave.seed));
  for (int x = 0; x < ax.corners; ++x) {
    const uint32_t hx =
        uint32_t(shared::foldCell(int32_t(uint32_t(ax.first) + uint32_t(x)), octave.period)) * kHashX;
    for (int y = 0; y < ay.corners; ++y) {
      const uint32_t hy =
          uint32_t(shared::foldCell(int32_t(uint32_t(ay.first) + uint32_t(y)), octave.period)) * kHashY;
      hn::Vec<decltype(d)> gx, gy, gz;
      gradients(d, mixed(spread(hn::Xor(hz, hn::Set(du, hx ^ hy)))), octave.turn, gx, gy, gz);
      hn::Store(gx, d, out.x[x][y]);
      hn::Store(gy, d, out.y[x][y]);
      hn::Store(gz, d, out.z[x][y]);
    }
  }
}

#if HWY_MAX_BYTES >= 64
using Row = hn::CappedTag<float, kRowLanes>;
HWY_INLINE hn::Vec<Tag> loadPlanes(const float* first, const float* second) {
  return hn::Combine(Tag(), hn::Load(Row(), second), hn::Load(Row(), first));
}
HWY_INLINE hn::Vec<Tag> setPlanes(const float* perPlane) {
  return hn::Combine(Tag(), hn::Set(Row(), perPlane[1]), hn::Set(Row(), perPlane[0]));
}
HWY_INLINE void addToPlanes(hn::Vec<Tag> v, float* first) {
  float* const second = first + kBlockEdge * kBlockEdge;
  hn::StoreU(hn::Add(hn::LoadU(Row(), first), hn::LowerHalf(v)), Row(), first);
  hn::StoreU(hn::Add(hn::LoadU(Row(), second), hn::UpperHalf(Row(), v)), Row(), second);
}
#else
HWY_INLINE hn::Vec<Tag> loadPlanes(const float* first, const float*) { return hn::Load(Tag(), first); }
HWY_INLINE hn::Vec<Tag> setPlanes(const float* perPlane) { return hn::Set(Tag(), perPlane[0]); }
HWY_INLINE void addToPlanes(hn::Vec<Tag> v, float* first) {
  hn::StoreU(hn::Add(hn::LoadU(Tag(), first), v), Tag(), first);
}
#endif

// Adds one octave to the rows of one group along z (all of z, or half).
HWY_INLINE void addGroup(const NoiseOctave& octave, const BlockAxis& ax, const BlockAxis& ay,
                         const BlockAxis& az, size_t group, float* sums) {
  const Tag d;
  const size_t z0 = group * kRowLanes;
  Corners corners;
  gather(octave, ax, ay, int32_t(uint32_t(az.first) + uint32_t(az.cell[z0])), corners);

  HWY_ALIGN int32_t lower[kLanes];
  HWY_ALIGN int32_t upper[kLanes];
  for (size_t lane = 0; lane < kLanes; ++lane) {
    const size_t plane = lane / kRowLanes * kRowLanes;
    lower[lane] = int32_t(plane) + az.cell[z0 + lane - plane] - az.cell[z0];
    upper[lane] = lower[lane] + 1;
  }
  const auto toLower = hn::SetTableIndices(d, lower), toUpper = hn::SetTableIndices(d, upper);
  const V dz0 = loadPlanes(az.place + z0, az.place + z0), dz1 = hn::Sub(dz0, hn::Set(d, 1.0f));
  const V sz = loadPlanes(az.weight + z0, az.weight + z0);
  const V weight = hn::Set(d, octave.weight * noiseScale(octave));

  for (size_t i = 0; i < size_t(kBlockEdge); i += kPlanes) {
    const int x = ax.cell[i], xNext = ax.cell[i + kPlanes - 1];
    const V dx0 = setPlanes(ax.place + i), dx1 = hn::Sub(dx0, hn::Set(d, 1.0f)),
            sx = setPlanes(ax.weight + i);
    V u[kMostCorners], v[kMostCorners], w[kMostCorners];
    for (int y = 0; y < ay.corners; ++y) {
      u[y] = mix(hn::Mul(loadPlanes(corners.x[x][y], corners.x[xNext][y]), dx0),
                 hn::Mul(loadPlanes(corners.x[x + 1][y], corners.x[xNext + 1][y]), dx1), sx);
      v[y] = mix(loadPlanes(corners.y[x][y], corners.y[xNext][y]),
                 loadPlanes(corners.y[x + 1][y], corners.y[xNext + 1][y]), sx);
      w[y] = mix(loadPlanes(corners.z[x][y], corners.z[xNext][y]),
                 loadPlanes(corners.z[x + 1][y], corners.z[xNext + 1][y]), sx);
    }
    for (size_t j = 0; j < size_t(kBlockEdge); ++j) {
      const int y = ay.cell[j];
      const V dy0 = hn::Set(d, ay.place[j]), dy1 = hn::Sub(dy0, hn::Set(d, 1.0f)),
              sy = hn::Set(d, ay.weight[j]);
      // At a corner k along z the four gradients of x and y make a value a + b · (z − k).
      const V a = mix(hn::Add(u[y], hn::Mul(v[y], dy0)), hn::Add(u[y + 1], hn::Mul(v[y + 1], dy1)), sy);
      const V b = mix(w[y], w[y + 1], sy);
      const V below =
          hn::Add(hn::TableLookupLanes(a, toLower), hn::Mul(hn::TableLookupLanes(b, toLower), dz0));
      const V above =
          hn::Add(hn::TableLookupLanes(a, toUpper), hn::Mul(hn::TableLookupLanes(b, toUpper), dz1));
      addToPlanes(hn::Mul(weight, mix(below, above, sz)), sums + i * 64 + j * 8 + z0);
    }
  }
}

void addBlock(const NoiseOctave& octave, const BlockAxis& ax, const BlockAxis& ay, const BlockAxis& az,
              float* sums) {
  for (size_t group = 0; group < kGroups; ++group) addGroup(octave, ax, ay, az, group, sums);
}

#else  // a machine without SSSE3: the same operations, one voxel at a time

#include "bake/fields/noise_lattice_scalar.h"

#endif

void addOnLattice(const NoiseOctave& octave, const Lattice& lattice, float* sums) {
  BlockAxis ax, ay, az;
  const float step = float(lattice.spacing / octave.cellSize);
  setAxis(lattice.origin.x - octave.offset.x, octave.cellSize, step, ax);
  setAxis(lattice.origin.y - octave.offset.y, octave.cellSize, step, ay);
  setAxis(lattice.origin.z - octave.offset.z, octave.cellSize, step, az);
  addBlock(octave, ax, ay, az, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(addOnLattice);

void addNoiseOnLattice(const NoiseOctave* octaves, size_t count, const Lattice& lattice, float* sums) {
  for (size_t n = 0; n < count; ++n) {
    if (lattice.spacing <= 0.5 * octaves[n].cellSize)
      HWY_DYNAMIC_DISPATCH(addOnLattice)(octaves[n], lattice, sums);
    else
      addNoiseAtPoints(octaves + n, 1, LatticePoints(lattice).points(), sums);
  }
}

}  // namespace nephele
#endif
