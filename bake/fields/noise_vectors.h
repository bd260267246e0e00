// What both kernels of gradient noise do in vectors: hash, fade, mix, gradients of lattice corners. Depends
// on turn.h, Highway. Compiled once for each target: included inside hwy/foreach_target.h's loop alone, and
// so guarded by Highway's toggle instead of a pragma.
#if defined(NEPHELE_NOISE_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef NEPHELE_NOISE_VECTORS_H
#undef NEPHELE_NOISE_VECTORS_H
#else
#define NEPHELE_NOISE_VECTORS_H
#endif

#include <hwy/highway.h>

#include "bake/fields/turn.h"

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

using Tag = hn::CappedTag<float, 16>;
using TagU = hn::RebindToUnsigned<Tag>;
using V = hn::Vec<Tag>;
using VU = hn::Vec<TagU>;

// The same constants as in shared::hashCorner, which NoiseKernels.AgreeWithTheDefinition holds them to.
constexpr uint32_t kHashX = 0x9e3779b1u, kHashY = 0x85ebca77u, kHashZ = 0xc2b2ae3du;
constexpr uint32_t kMix = 0x2c1b3c6du;

// shared::hashCorner of a key is mixed(spread(key)): the gradient's number in the top four bits, its turn in
// the next two. spread of a xor is the xor of spreads, so that a key's parts are spread once for many
// corners.
template <class VU>
HWY_INLINE VU spread(VU key) {
  return hn::Xor(key, hn::ShiftRight<15>(key));
}
template <class VU>
HWY_INLINE VU mixed(VU spreadKey) {
  return hn::Mul(spreadKey, hn::Set(hn::DFromV<VU>(), kMix));
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

#endif

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#endif
