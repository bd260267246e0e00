// Gradient noise by SIMD. On a block, the lattice corners are gathered once; gradients are mixed over x and y
// in vectors whose lanes are the corners along z, and a permutation hands each voxel of a row its two
// corners. Depends on perlin.h, Highway.
#include "bake/fields/noise_kernels.h"

#include "bake/fields/cell_place.h"
#include "bake/fields/shared_text.h"

#ifndef NEPHELE_NOISE_GRADIENTS
#define NEPHELE_NOISE_GRADIENTS
namespace nephele {
/// The 16 gradients of shared::gradientDot, aligned for the widest vector.
alignas(64) constexpr float kGradientX[16] = {1, -1, 1, -1, 1, -1, 1, -1, 0, 0, 0, 0, 1, 0, -1, 0};
alignas(64) constexpr float kGradientY[16] = {1, 1, -1, -1, 0, 0, 0, 0, 1, -1, 1, -1, 1, -1, 1, -1};
alignas(64) constexpr float kGradientZ[16] = {0, 0, 0, 0, 1, 1, -1, -1, 1, 1, -1, -1, 0, 1, 0, -1};
}  // namespace nephele
#endif

// Vectors of a size that is unknown until run time can be held in no array, as these kernels do.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/noise_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

// The same constants as in shared::hashCorner, which NoiseKernels.AgreeWithTheDefinition holds them to.
constexpr uint32_t kHashX = 0x9e3779b1u, kHashY = 0x85ebca77u, kHashZ = 0xc2b2ae3du;
constexpr uint32_t kMix = 0x2c1b3c6du;

// shared::hashCorner of a key: the gradient's number in the top four bits, its turn in the next two.
template <class DU, class VU = hn::Vec<DU>>
HWY_INLINE VU mixHash(DU du, VU h) {
  return hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), hn::Set(du, kMix));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V fade(D d, V t) {
  const V inner =
      hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, hn::Set(d, 6.0f)), hn::Set(d, 15.0f))), hn::Set(d, 10.0f));
  return hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
}

template <class V>
HWY_INLINE V mix(V a, V b, V t) {
  return hn::Add(a, hn::Mul(t, hn::Sub(b, a)));
}

// How shared::gradientDot chooses: u is x or y, v is y, x or z, each with a sign.
template <class D>
struct Choice {
  using VU = hn::Vec<hn::RebindToUnsigned<D>>;
  using M = hn::Mask<D>;
  M uIsX, vIsY, vIsX;
  VU signU, signV;  // the sign bit, all else 0

  HWY_INLINE Choice(D d, VU hash) {
    const hn::RebindToUnsigned<D> du;
    const auto has = [&](uint32_t mask, uint32_t value) HWY_ATTR {
      return hn::RebindMask(d, hn::Eq(hn::And(hash, hn::Set(du, mask << 28)), hn::Set(du, value << 28)));
    };
    const VU sign = hn::Set(du, 0x80000000u);
    uIsX = has(8u, 0u);
    vIsY = has(12u, 0u);
    vIsX = has(13u, 12u);
    signU = hn::And(hn::ShiftLeft<3>(hash), sign);
    signV = hn::And(hn::ShiftLeft<2>(hash), sign);
  }
};

// The two components ±1 of a gradient in its plane, turned as shared::turnedGradient does.
template <class D, class V, class VU>
HWY_INLINE void turnInPlane(D d, VU hash, const Turn& turn, V& su, V& sv) {
  const hn::RebindToUnsigned<D> du;
  constexpr uint32_t kTwice = 0x04000000u;  // shared::turnOf reads the bits below the gradient's number
  const auto twice = hn::RebindMask(d, hn::Eq(hn::And(hash, hn::Set(du, kTwice)), hn::Set(du, kTwice)));
  const VU back = hn::And(hn::ShiftLeft<4>(hash), hn::Set(du, 0x80000000u));
  const V cosine = hn::IfThenElse(twice, hn::Set(d, turn.at.z), hn::Set(d, turn.at.x));
  const V sine =
      hn::Xor(hn::IfThenElse(twice, hn::Set(d, turn.at.w), hn::Set(d, turn.at.y)), hn::BitCast(d, back));
  const V u = hn::Sub(hn::Mul(su, cosine), hn::Mul(sv, sine));
  sv = hn::Add(hn::Mul(sv, cosine), hn::Mul(su, sine));
  su = u;
}

// Gradients along each axis: ±1 or 0, or turned.
template <class D, class V, class VU>
HWY_INLINE void gradients(D d, VU hash, const Turn& turn, V& gx, V& gy, V& gz) {
  const Choice<D> choice(d, hash);
  const V one = hn::Set(d, 1.0f);
  V su = hn::Xor(one, hn::BitCast(d, choice.signU)), sv = hn::Xor(one, hn::BitCast(d, choice.signV));
  if (turn.evolves) turnInPlane(d, hash, turn, su, sv);
  // u and v never fall to one axis.
  gx = hn::IfThenElse(choice.uIsX, su, hn::IfThenElseZero(choice.vIsX, sv));
  gy = hn::IfThenElse(choice.uIsX, hn::IfThenElseZero(choice.vIsY, sv), su);
  gz = hn::IfThenZeroElse(hn::Or(choice.vIsY, choice.vIsX), sv);
}

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
using Tag = hn::CappedTag<float, 16>;
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
      gradients(d, mixHash(du, hn::Xor(hz, hn::Set(du, hx ^ hy))), octave.turn, gx, gy, gz);
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
  using V = hn::Vec<Tag>;
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

HWY_INLINE glm::vec3 plainGradient(uint32_t hash) {
  const uint32_t number = hash >> 28;
  return {kGradientX[number], kGradientY[number], kGradientZ[number]};
}

// A corner's gradient times the place relative to it, as shared::gradientDot; and one gradient alone.
#if HWY_MAX_BYTES >= 64
// Sixteen lanes hold the whole table of gradients. A product with 0 adds ±0, which changes no sum that is not
// 0.
struct GradientTable {
  hn::Vec<Tag> x, y, z;
  HWY_INLINE GradientTable()
      : x(hn::Load(Tag(), kGradientX)), y(hn::Load(Tag(), kGradientY)), z(hn::Load(Tag(), kGradientZ)) {}
  template <class V, class VU>
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    const auto h = hn::IndicesFromVec(Tag(), hn::ShiftRight<28>(hash));
    return hn::Add(hn::Add(hn::Mul(hn::TableLookupLanes(x, h), dx), hn::Mul(hn::TableLookupLanes(y, h), dy)),
                   hn::Mul(hn::TableLookupLanes(z, h), dz));
  }
  HWY_INLINE glm::vec3 of(uint32_t hash) const { return plainGradient(hash); }
};
#else
struct GradientTable {
  template <class V, class VU>
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    const hn::DFromV<V> d;
    const Choice<hn::DFromV<V>> choice(d, hash);
    const V u = hn::IfThenElse(choice.uIsX, dx, dy);
    const V v = hn::IfThenElse(choice.vIsY, dy, hn::IfThenElse(choice.vIsX, dx, dz));
    return hn::Add(hn::Xor(u, hn::BitCast(d, choice.signU)), hn::Xor(v, hn::BitCast(d, choice.signV)));
  }
  HWY_INLINE glm::vec3 of(uint32_t hash) const { return plainGradient(hash); }
};
#endif

// The same for gradients that turn.
struct TurnedGradients {
  const Turn& turn;
  template <class V, class VU>
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    const hn::DFromV<V> d;
    V gx, gy, gz;
    gradients(d, hash, turn, gx, gy, gz);
    return hn::Add(hn::Add(hn::Mul(gx, dx), hn::Mul(gy, dy)), hn::Mul(gz, dz));
  }
  HWY_INLINE glm::vec3 of(uint32_t hash) const { return shared::turnedGradient(hash, turn.at); }
};

// Mixes a cell's corners; dot(x, y, z, dx, dy, dz) is the product at corner (x, y, z), each 0 or 1, for the
// place relative to it.
template <class D, class V, class Dot>
HWY_INLINE V mixCell(D d, V x0, V y0, V z0, float scale, const Dot& dot) {
  const V one = hn::Set(d, 1.0f);
  const V x1 = hn::Sub(x0, one), y1 = hn::Sub(y0, one), z1 = hn::Sub(z0, one);
  const V sx = fade(d, x0), sy = fade(d, y0), sz = fade(d, z0);
  const V low = mix(mix(dot(0, 0, 0, x0, y0, z0), dot(1, 0, 0, x1, y0, z0), sx),
                    mix(dot(0, 1, 0, x0, y1, z0), dot(1, 1, 0, x1, y1, z0), sx), sy);
  const V high = mix(mix(dot(0, 0, 1, x0, y0, z1), dot(1, 0, 1, x1, y0, z1), sx),
                     mix(dot(0, 1, 1, x0, y1, z1), dot(1, 1, 1, x1, y1, z1), sx), sy);
  return hn::Mul(mix(low, high, sz), hn::Set(d, scale));
}

// One vector of points, given as places relative to a first cell. kMayShare: asks first whether all lie in
// one cell; the answer changes no bits.
template <bool kMayShare, class D, class Gradients, class V = hn::Vec<D>>
HWY_INLINE V noiseAt(D d, const Gradients& table, float scale, V x, V y, V z, uint32_t cellX, uint32_t cellY,
                     uint32_t cellZ, uint32_t seed) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const V wx = hn::Floor(x), wy = hn::Floor(y), wz = hn::Floor(z);
  const V x0 = hn::Sub(x, wx), y0 = hn::Sub(y, wy), z0 = hn::Sub(z, wz);
  if (kMayShare) {
    const float ax = hn::GetLane(wx), ay = hn::GetLane(wy), az = hn::GetLane(wz);
    const auto strays =
        hn::Or(hn::Or(hn::Ne(wx, hn::Set(d, ax)), hn::Ne(wy, hn::Set(d, ay))), hn::Ne(wz, hn::Set(d, az)));
    if (hn::AllFalse(d, strays)) {  // all in one cell, as coarse octaves mostly are: its gradients once
      const uint32_t bx = cellX + uint32_t(int32_t(ax)), by = cellY + uint32_t(int32_t(ay)),
                     bz = cellZ + uint32_t(int32_t(az));
      return mixCell(
          d, x0, y0, z0, scale, [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz) HWY_ATTR {
            const glm::vec3 g =
                table.of(shared::hashCorner({int32_t(bx + ox), int32_t(by + oy), int32_t(bz + oz)}, seed));
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, g.x), dx), hn::Mul(hn::Set(d, g.y), dy)),
                           hn::Mul(hn::Set(d, g.z), dz));
          });
    }
  }
  const auto hashed = [&](V whole, uint32_t cell, uint32_t prime) HWY_ATTR {
    const auto at = hn::Add(hn::BitCast(du, hn::ConvertTo(di, whole)), hn::Set(du, cell));
    return hn::Mul(at, hn::Set(du, prime));
  };
  using VU = hn::Vec<hn::RebindToUnsigned<D>>;
  const VU plainX = hashed(wx, cellX, kHashX), plainY = hashed(wy, cellY, kHashY),
           plainZ = hashed(wz, cellZ, kHashZ);
  const VU seeds = hn::Set(du, seed);
  // A key's xor with its own shift is that of its parts: mixHash's first step is taken once a part.
  const auto spread = [](VU key) HWY_ATTR { return hn::Xor(key, hn::ShiftRight<15>(key)); };
  const VU hx[2] = {spread(plainX), spread(hn::Add(plainX, hn::Set(du, kHashX)))};
  const VU hy[2] = {plainY, hn::Add(plainY, hn::Set(du, kHashY))};
  const VU hz[2] = {hn::Xor(plainZ, seeds), hn::Xor(hn::Add(plainZ, hn::Set(du, kHashZ)), seeds)};
  const VU hyz[4] = {spread(hn::Xor(hy[0], hz[0])), spread(hn::Xor(hy[1], hz[0])),
                     spread(hn::Xor(hy[0], hz[1])), spread(hn::Xor(hy[1], hz[1]))};
  return mixCell(d, x0, y0, z0, scale, [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz) HWY_ATTR {
    const VU hash = hn::Mul(hn::Xor(hx[ox], hyz[oy + 2 * oz]), hn::Set(du, kMix));
    return table.dot(hash, dx, dy, dz);
  });
}

// Whether a vector of neighbouring points mostly lies in one cell, judged by one in the middle: the chance is
// one less the way from its first point to its last, in cells.
HWY_INLINE bool oftenShared(const Points& points, float frequency, size_t lanes) {
  if (points.count < lanes) return false;
  const size_t first = (points.count - lanes) / 2, last = first + lanes - 1;
  const auto way = [&](const float* at) { return std::abs(at[last] - at[first]) * frequency; };
  return way(points.x) + way(points.y) + way(points.z) < 0.5f;
}

// Whole vectors of points from the first on; returns how many points those are.
template <bool kMayShare, class Gradients>
HWY_INLINE size_t addVectors(const Gradients& table, const NoiseOctave& octave, const Points& points,
                             float* sums) {
  const Tag d;
  const size_t lanes = hn::Lanes(d);
  const float scale = noiseScale(octave);
  const CellPlace px = cellPlace(points.origin.x - octave.offset.x, octave.cellSize),
                  py = cellPlace(points.origin.y - octave.offset.y, octave.cellSize),
                  pz = cellPlace(points.origin.z - octave.offset.z, octave.cellSize);
  const auto frequency = hn::Set(d, float(1.0 / octave.cellSize)), weight = hn::Set(d, octave.weight);
  size_t n = 0;
  for (; n + lanes <= points.count; n += lanes) {
    const auto x = hn::Add(hn::Set(d, px.fraction), hn::Mul(hn::LoadU(d, points.x + n), frequency));
    const auto y = hn::Add(hn::Set(d, py.fraction), hn::Mul(hn::LoadU(d, points.y + n), frequency));
    const auto z = hn::Add(hn::Set(d, pz.fraction), hn::Mul(hn::LoadU(d, points.z + n), frequency));
    const auto noise = noiseAt<kMayShare>(d, table, scale, x, y, z, uint32_t(px.cell), uint32_t(py.cell),
                                          uint32_t(pz.cell), octave.seed);
    hn::StoreU(hn::Add(hn::LoadU(d, sums + n), hn::Mul(weight, noise)), d, sums + n);
  }
  return n;
}

template <class Gradients>
HWY_INLINE size_t addWith(const Gradients& table, const NoiseOctave& octave, const Points& points,
                          float* sums) {
  return oftenShared(points, float(1.0 / octave.cellSize), hn::Lanes(Tag()))
             ? addVectors<true>(table, octave, points, sums)
             : addVectors<false>(table, octave, points, sums);
}

size_t addAtPoints(const NoiseOctave& octave, const Points& points, float* sums) {
  if (octave.turn.evolves) return addWith(TurnedGradients{octave.turn}, octave, points, sums);
  return addWith(GradientTable(), octave, points, sums);
}

#else  // a machine without SSSE3: the same operations, one voxel at a time

#include "bake/fields/noise_kernels_scalar.h"

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
HWY_EXPORT(addAtPoints);

namespace {

/// Points from `first` on, by the definition: the rest of a vector, and periods, whose folding costs a
/// division a corner.
void addByDefinition(const NoiseOctave& octave, const Points& points, size_t first, float* sums) {
  const CellPlace px = cellPlace(points.origin.x - octave.offset.x, octave.cellSize),
                  py = cellPlace(points.origin.y - octave.offset.y, octave.cellSize),
                  pz = cellPlace(points.origin.z - octave.offset.z, octave.cellSize);
  const float frequency = float(1.0 / octave.cellSize);
  for (size_t n = first; n < points.count; ++n) {
    const float x = px.fraction + points.x[n] * frequency;
    const float y = py.fraction + points.y[n] * frequency;
    const float z = pz.fraction + points.z[n] * frequency;
    const float wx = std::floor(x), wy = std::floor(y), wz = std::floor(z);
    sums[n] += octave.weight *
               noiseInCell(octave, {cellAfter(px.cell, wx), cellAfter(py.cell, wy), cellAfter(pz.cell, wz)},
                           {x - wx, y - wy, z - wz});
  }
}

}  // namespace

void addNoiseAtPoints(const NoiseOctave& octave, const Points& points, float* sums) {
  const size_t done = octave.period == 0 ? HWY_DYNAMIC_DISPATCH(addAtPoints)(octave, points, sums) : 0;
  addByDefinition(octave, points, done, sums);
}

void addNoiseOnLattice(const NoiseOctave* octaves, size_t count, const Lattice& lattice, float* sums) {
  for (size_t n = 0; n < count; ++n) {
    if (lattice.spacing <= 0.5 * octaves[n].cellSize)
      HWY_DYNAMIC_DISPATCH(addOnLattice)(octaves[n], lattice, sums);
    else
      addNoiseAtPoints(octaves[n], LatticePoints(lattice).points(), sums);
  }
}

}  // namespace nephele
#endif
