// The march's shared text as C++: a struct over any source of brick densities. Depends on shaders/shared
// alone. Compile what includes it with -Wconversion -Wdouble-promotion.
#pragma once

#include "shaders/shared/leaves.h"

namespace nephele::shared {

/// A lat-long picture and its table as scene/environment_map.h keeps them; looked at for that kind of
/// environment alone.
struct SkyArrays {
  const vec3* texels = nullptr;
  const vec4* cells = nullptr;
};

/// `Bricks` has `uint slot(ivec3 brick) const` (0: no density) and `float density(uint slot, vec3 position)
/// const` (position in [0, 8] voxels from the brick's corner). Thread-safe to copy and use where Bricks is.
template <class Bricks>
struct March {
  MarchParameters params;
  const Bricks* bricks;
  SkyArrays skyArrays{};

  uint brickSlot(ivec3 brick) const { return bricks->slot(brick); }
  float brickDensity(uint slot, vec3 position) const { return bricks->density(slot, position); }
  vec3 environmentTexel(ivec2 texel) const { return skyArrays.texels[texel.y * params.skySize.x + texel.x]; }
  vec4 environmentCell(int cell) const { return skyArrays.cells[cell]; }

#include "shaders/shared/environment.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/march.glsl"
#include "shaders/shared/walk.glsl"
};

}  // namespace nephele::shared
