// Gradient noise at points that reach over few cells: corners come from vectors that hold all of them, or all
// of an axis' keys. Depends on noise_vectors.h, Highway. Compiled once for each target: included inside
// hwy/foreach_target.h's loop alone, and so guarded by Highway's toggle instead of a pragma.
#if defined(NEPHELE_NOISE_NEAR_H) == defined(HWY_TARGET_TOGGLE)
#ifdef NEPHELE_NOISE_NEAR_H
#undef NEPHELE_NOISE_NEAR_H
#else
#define NEPHELE_NOISE_NEAR_H
#endif

#include <hwy/highway.h>

#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/noise_gradients.h"
#include "bake/fields/noise_vectors.h"
#include "bake/fields/shared_text.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

HWY_INLINE glm::vec3 plainGradient(uint32_t hash) {
  const uint32_t number = hash >> 28;
  return {kGradientX[number], kGradientY[number], kGradientZ[number]};
}

HWY_INLINE V dotted(V gx, V gy, V gz, V dx, V dy, V dz) {
  return hn::Add(hn::Add(hn::Mul(gx, dx), hn::Mul(gy, dy)), hn::Mul(gz, dz));
}

// A corner's gradient times the place relative to it, as shared::gradientDot; gradients alone; and one of
// them.
#if HWY_MAX_BYTES >= 64
// Sixteen lanes hold the whole table of gradients. A product with 0 adds ±0, which changes no sum that is not
// 0.
struct PlainGradients {
  V x, y, z;
  HWY_INLINE PlainGradients()
      : x(hn::Load(Tag(), kGradientX)), y(hn::Load(Tag(), kGradientY)), z(hn::Load(Tag(), kGradientZ)) {}
  HWY_INLINE void find(VU hash, V& gx, V& gy, V& gz) const {
    const auto h = hn::IndicesFromVec(Tag(), hn::ShiftRight<28>(hash));
    gx = hn::TableLookupLanes(x, h), gy = hn::TableLookupLanes(y, h), gz = hn::TableLookupLanes(z, h);
  }
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    V gx, gy, gz;
    find(hash, gx, gy, gz);
    return dotted(gx, gy, gz, dx, dy, dz);
  }
  HWY_INLINE glm::vec3 of(uint32_t hash) const { return plainGradient(hash); }
};
#else
struct PlainGradients {
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    const Tag d;
    const Choice<Tag> choice(d, hash);
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
  HWY_INLINE void find(VU hash, V& gx, V& gy, V& gz) const { gradients(Tag(), hash, turn, gx, gy, gz); }
  HWY_INLINE V dot(VU hash, V dx, V dy, V dz) const {
    V gx, gy, gz;
    find(hash, gx, gy, gz);
    return dotted(gx, gy, gz, dx, dy, dz);
  }
  HWY_INLINE glm::vec3 of(uint32_t hash) const { return shared::turnedGradient(hash, turn.at); }
};

// Mixes a cell's corners; dot(x, y, z, dx, dy, dz) is the product at corner (x, y, z), each 0 or 1, for the
// place relative to it.
template <class Dot>
HWY_INLINE V mixCell(V x0, V y0, V z0, V scale, const Dot& dot) {
  const Tag d;
  const V one = hn::Set(d, 1.0f);
  const V x1 = hn::Sub(x0, one), y1 = hn::Sub(y0, one), z1 = hn::Sub(z0, one);
  const V sx = fade(d, x0), sy = fade(d, y0), sz = fade(d, z0);
  const V low = mix(mix(dot(0, 0, 0, x0, y0, z0), dot(1, 0, 0, x1, y0, z0), sx),
                    mix(dot(0, 1, 0, x0, y1, z0), dot(1, 1, 0, x1, y1, z0), sx), sy);
  const V high = mix(mix(dot(0, 0, 1, x0, y0, z1), dot(1, 0, 1, x1, y0, z1), sx),
                     mix(dot(0, 1, 1, x0, y1, z1), dot(1, 1, 1, x1, y1, z1), sx), sy);
  return hn::Mul(mix(low, high, sz), scale);
}

HWY_INLINE V dotWithOne(const glm::vec3& g, V dx, V dy, V dz) {
  const Tag d;
  return dotted(hn::Set(d, g.x), hn::Set(d, g.y), hn::Set(d, g.z), dx, dy, dz);
}

// The same for keys of the cell's corners along each axis, spread and with the seed among them.
template <class Gradients>
HWY_INLINE V mixHashed(const Gradients& table, const VU* hx, const VU* hy, const VU* hz, V x0, V y0, V z0,
                       V scale) {
  const VU hyz[4] = {hn::Xor(hy[0], hz[0]), hn::Xor(hy[1], hz[0]), hn::Xor(hy[0], hz[1]),
                     hn::Xor(hy[1], hz[1])};
  return mixCell(x0, y0, z0, scale, [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz) HWY_ATTR {
    return table.dot(mixed(hn::Xor(hx[ox], hyz[oy + 2 * oz])), dx, dy, dz);
  });
}

// A batch that lies in one cell.
struct OneCellNoise {
  float cell[3];  // relative to the batch's first
  glm::vec3 gradient[8];
  V scale;

  HWY_INLINE V operator()(V x, V y, V z) const {
    const Tag d;
    return mixCell(hn::Sub(x, hn::Set(d, cell[0])), hn::Sub(y, hn::Set(d, cell[1])),
                   hn::Sub(z, hn::Set(d, cell[2])), scale,
                   [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz)
                       HWY_ATTR { return dotWithOne(gradient[ox + 2 * oy + 4 * oz], dx, dy, dz); });
  }
};

// The lattice planes that a batch needs along one axis.
struct Planes {
  static constexpr int kMost = 17;  // a vector's cells, and one more
  int count = 0;                    // 0: too many, or too far from the batch's origin
  float first = 0.0f;               // relative to the batch's first cell
  HWY_ALIGN uint32_t key[kMost];    // cell times prime, folded into the period

  Planes(const CellPlace& place, float frequency, float low, float high, int period, uint32_t prime) {
    // Cells this near make sums of 17 of their numbers exact in floats, and in kWhole's place below.
    constexpr float kNear = 131072.0f;
    const float begin = std::floor(place.fraction + low * frequency),
                end = std::floor(place.fraction + high * frequency);
    if (!(std::abs(begin) < kNear && std::abs(end) < kNear && end - begin <= float(kMost - 2))) return;
    first = begin;
    count = int(end - begin) + 2;
    const uint32_t cell = uint32_t(cellAfter(place.cell, begin));
    for (uint32_t n = 0; n < uint32_t(kMost); ++n) key[n] = (cell + n) * prime;
    if (period == 0) return;
    for (int n = 0; n < count; ++n)
      key[n] = uint32_t(shared::foldCell(int32_t(cell + uint32_t(n)), period)) * prime;
  }
};

#if HWY_MAX_BYTES >= 64

// A float of at most 22 bits before the point plus kWhole holds it as the difference of its bits to
// kWholeBits.
constexpr float kWhole = 12582912.0f;  // 1.5 · 2^23
constexpr uint32_t kWholeBits = 0x4b400000u;

// A batch whose cells have at most 16 corners in all: their gradients, z fastest.
struct FewCornersNoise {
  V gx, gy, gz;
  V stepX, stepY, shift;  // a cell's number is stepX · x + stepY · y + z + shift
  uint32_t nextX, nextY;  // the same steps
  V scale;

  HWY_INLINE V operator()(V x, V y, V z) const {
    const TagU du;
    const V wx = hn::Floor(x), wy = hn::Floor(y), wz = hn::Floor(z);
    const VU cell =
        hn::BitCast(du, hn::Add(hn::Add(hn::Mul(wx, stepX), hn::Mul(wy, stepY)), hn::Add(wz, shift)));
    return mixCell(hn::Sub(x, wx), hn::Sub(y, wy), hn::Sub(z, wz), scale,
                   [&](uint32_t ox, uint32_t oy, uint32_t oz, V dx, V dy, V dz) HWY_ATTR {
                     const uint32_t corner = ox * nextX + oy * nextY + oz;
                     const auto at =
                         hn::IndicesFromVec(Tag(), hn::Sub(cell, hn::Set(du, kWholeBits - corner)));
                     return dotted(hn::TableLookupLanes(gx, at), hn::TableLookupLanes(gy, at),
                                   hn::TableLookupLanes(gz, at), dx, dy, dz);
                   });
  }
};

template <class Gradients>
HWY_INLINE FewCornersNoise fewCorners(const Gradients& table, const Planes& px, const Planes& py,
                                      const Planes& pz, uint32_t seed, V scale) {
  const Tag d;
  const TagU du;
  HWY_ALIGN uint32_t keys[16] = {};
  size_t n = 0;
  for (int x = 0; x < px.count; ++x)
    for (int y = 0; y < py.count; ++y)
      for (int z = 0; z < pz.count; ++z) keys[n++] = px.key[x] ^ py.key[y] ^ pz.key[z] ^ seed;
  const int nextX = py.count * pz.count, nextY = pz.count;
  const float shift = kWhole - (float(nextX) * px.first + float(nextY) * py.first + pz.first);
  V gx, gy, gz;
  table.find(mixed(spread(hn::Load(du, keys))), gx, gy, gz);
  return {gx,
          gy,
          gz,
          hn::Set(d, float(nextX)),
          hn::Set(d, float(nextY)),
          hn::Set(d, shift),
          uint32_t(nextX),
          uint32_t(nextY),
          scale};
}

// A batch of at most 16 cells along each axis, whose spread keys fit in vectors.
template <class Gradients>
struct KeyedNoise {
  const Gradients& table;
  VU x0, x1, y0, y1, z0, z1;  // keys of a cell's lower and upper planes
  V shiftX, shiftY, shiftZ;
  V scale;

  HWY_INLINE V operator()(V x, V y, V z) const {
    const V wx = hn::Floor(x), wy = hn::Floor(y), wz = hn::Floor(z);
    const auto ix = number(wx, shiftX), iy = number(wy, shiftY), iz = number(wz, shiftZ);
    const VU hx[2] = {hn::TableLookupLanes(x0, ix), hn::TableLookupLanes(x1, ix)};
    const VU hy[2] = {hn::TableLookupLanes(y0, iy), hn::TableLookupLanes(y1, iy)};
    const VU hz[2] = {hn::TableLookupLanes(z0, iz), hn::TableLookupLanes(z1, iz)};
    return mixHashed(table, hx, hy, hz, hn::Sub(x, wx), hn::Sub(y, wy), hn::Sub(z, wz), scale);
  }

 private:
  static HWY_INLINE auto number(V whole, V shift) {
    const TagU du;
    return hn::IndicesFromVec(du, hn::Sub(hn::BitCast(du, hn::Add(whole, shift)), hn::Set(du, kWholeBits)));
  }
};

template <class Gradients>
HWY_INLINE KeyedNoise<Gradients> keyed(const Gradients& table, const Planes& px, const Planes& py,
                                       const Planes& pz, uint32_t seed, V scale) {
  const Tag d;
  const TagU du;
  const VU seeds = hn::Set(du, seed);
  return {table,
          spread(hn::Load(du, px.key)),
          spread(hn::LoadU(du, px.key + 1)),
          spread(hn::Load(du, py.key)),
          spread(hn::LoadU(du, py.key + 1)),
          spread(hn::Xor(hn::Load(du, pz.key), seeds)),
          spread(hn::Xor(hn::LoadU(du, pz.key + 1), seeds)),
          hn::Set(d, kWhole - px.first),
          hn::Set(d, kWhole - py.first),
          hn::Set(d, kWhole - pz.first),
          scale};
}

#endif

template <class Gradients>
HWY_INLINE OneCellNoise oneCell(const Gradients& table, const Planes& px, const Planes& py, const Planes& pz,
                                uint32_t seed, V scale) {
  OneCellNoise noise{{px.first, py.first, pz.first}, {}, scale};
  for (uint32_t c = 0; c < 8; ++c) {
    const uint32_t key = px.key[c & 1] ^ py.key[(c >> 1) & 1] ^ pz.key[c >> 2] ^ seed;
    noise.gradient[c] = table.of((key ^ (key >> 15)) * kMix);
  }
  return noise;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#endif
