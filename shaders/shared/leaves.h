// The leaves of the light's shared text as C++ (phase, random, ray and box, chord, powder, step integral) and
// the parameter struct, in namespace nephele::shared. Depends on GLM alone; the march itself is
// preview/twin/march.h.
#pragma once

#include <cstddef>

#include "shaders/shared/dialect.h"

namespace nephele::shared {

// Later texts use earlier ones.
// clang-format off
#include "shaders/shared/parameters.glsl"
#include "shaders/shared/phase.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/ray_box.glsl"
#include "shaders/shared/remap.glsl"
#include "shaders/shared/chord.glsl"
#include "shaders/shared/powder.glsl"
#include "shaders/shared/step_integral.glsl"
// clang-format on

// std140 puts every member on a multiple of 16 bytes; so must the C++ compiler, since the struct goes up by
// memcpy.
inline constexpr size_t kRowBytes = 16;
inline constexpr size_t kRowsBeforeLights = 41;
inline constexpr size_t kRowsPerLight = 3;
static_assert(sizeof(vec4) == kRowBytes && sizeof(ivec4) == kRowBytes);
static_assert(sizeof(LightParameters) == kRowsPerLight * kRowBytes);
static_assert(offsetof(MarchParameters, counts) == 39 * kRowBytes);
static_assert(offsetof(MarchParameters, lights) == kRowsBeforeLights * kRowBytes);
inline constexpr size_t kRowsBehindLights = 5 + kBlackbodyNodes + 7;
static_assert(sizeof(MarchParameters) ==
              (kRowsBeforeLights + kRowsPerLight * kMaxLights + kRowsBehindLights) * kRowBytes);

/// What the march is told of where bricks lie; `Layout` is nephele::BrickLayout.
template <class Layout>
void describeLayout(MarchParameters& p, const Layout& layout) {
  p.walk.y = layout.maximum;
  p.counts.z = layout.scaled() ? 1 : 0;
  p.blockCount = ivec4(layout.blockCount, p.blockCount.w);
  p.cacheShape.z = layout.blockPlaces.z * p.cacheShape.x;
  p.cacheShape.w = layout.mostRise > 0 ? 1 : 0;
}

}  // namespace nephele::shared
