// Depends on displace.h, Highway.
#include "bake/fields/displace.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/fields/displace.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace nephele {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// values[n] = from[n] + scale · values[n] for the 64 points of a plane.
HWY_INLINE void addScaled(const float* from, float scale, float* values) {
  const hn::CappedTag<float, 16> d;
  const auto by = hn::Set(d, scale);
  for (size_t n = 0; n < size_t(kBlockEdge * kBlockEdge); n += hn::Lanes(d))
    hn::StoreU(hn::Add(hn::LoadU(d, from + n), hn::Mul(by, hn::LoadU(d, values + n))), d, values + n);
}

void displace(const float* along, float scale, float* x, float* y, float* z) {
  constexpr size_t kPlane = kBlockEdge * kBlockEdge;
  alignas(kBlockAlignment) float planeX[kPlane];
  alignas(kBlockAlignment) float planeY[kPlane];
  alignas(kBlockAlignment) float planeZ[kPlane];
  for (size_t n = 0; n < kPlane; ++n) {
    planeY[n] = along[n / kBlockEdge];
    planeZ[n] = along[n % kBlockEdge];
  }
  for (size_t i = 0; i < size_t(kBlockEdge); ++i) {
    for (float& place : planeX) place = along[i];
    addScaled(planeX, scale, x + i * kPlane);
    addScaled(planeY, scale, y + i * kPlane);
    addScaled(planeZ, scale, z + i * kPlane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nephele
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nephele {
HWY_EXPORT(displace);

void displaceOnLattice(const Lattice& lattice, float scale, float shift[3][kBlockPoints]) {
  float along[kBlockEdge];
  for (int n = 0; n < kBlockEdge; ++n) along[n] = float(n * lattice.spacing);
  HWY_DYNAMIC_DISPATCH(displace)(along, scale, shift[0], shift[1], shift[2]);
}

}  // namespace nephele
#endif
