// The march's shared text as C++: a struct over any source of bricks and cached light. Depends on
// shaders/shared alone. Compile what includes it with -Wconversion -Wdouble-promotion.
#pragma once

#include "shaders/shared/leaves.h"

namespace nephele::shared {

/// A lat-long picture and its table as scene/environment_map.h keeps them; looked at for that kind of
/// environment alone.
struct SkyArrays {
  const vec3* texels = nullptr;
  const vec4* cells = nullptr;
};

/// `Source` has
///   uvec2 word(ivec3 brick) const                     as volume/brick_layout.h says
///   float density(uvec2 word, vec3 kept, ivec3 samples) const     of the `samples` that the brick keeps,
///   from the
///                                                     first, without its scale
///   float sample(uvec2 word, ivec3 kept) const        one of those, likewise; asked by walkVoxels alone
///   uint block(ivec3 block) const, float column(vec3 texel) const, vec4 sky(int part, vec3 texel) const
///                                                     asked where parameters.cache or cacheShape say so
///   uvec2 heatWord(ivec3 brick) const, float heatValue(uvec2 word, vec3 kept, ivec3 samples) const
///                                                     the same of temperatures, where parameters.emission is
///                                                     on
/// Thread-safe to copy and use where Source is.
template <class Source>
struct March {
  MarchParameters params;
  const Source* bricks;
  SkyArrays skyArrays{};

  uvec2 brickWord(ivec3 brick) const { return bricks->word(brick); }
  float scaleOf(uvec2 word) { return params.counts.z != 0 ? wordMaximum(word) : 1.0f; }
  float brickDensity(uvec2 word, vec3 position) {
    return bricks->density(word, keptPosition(word, position), wordSamples(word)) * scaleOf(word);
  }
  float brickSample(uvec2 word, ivec3 place) {
    return bricks->sample(word, ivec3(keptPosition(word, vec3(place)))) * scaleOf(word);
  }
  uvec2 storedWord(ivec3 brick) const { return bricks->word(brick); }
  uint blockWord(ivec3 block) const { return bricks->block(block); }
  float cachedColumn(vec3 texel) const { return bricks->column(texel); }
  vec4 cachedSky(int part, vec3 texel) const { return bricks->sky(part, texel); }
  vec3 environmentTexel(ivec2 texel) const { return skyArrays.texels[texel.y * params.skySize.x + texel.x]; }
  vec4 environmentCell(int cell) const { return skyArrays.cells[cell]; }

  uvec2 heatWord(ivec3 brick) const { return bricks->heatWord(brick); }
  float heatValue(uvec2 word, vec3 position) {
    return bricks->heatValue(word, keptPosition(word, position), wordSamples(word));
  }

#define NPH_EMISSION (params.emission.x > 0.0f)
#define NPH_CACHED (params.cache.x > 0.0f)
#define NPH_CHECK 0
#define NPH_LEVELS (params.cacheShape.w != 0)
#define NPH_GREY (params.sigmaT.x == params.sigmaT.y && params.sigmaT.y == params.sigmaT.z)
#define NPH_MAP true
#define NPH_SHOWN_SKY true
#define NPH_NEAR (params.cache.w > 0.0f)
#define NPH_POINTS true
#define NPH_POWDER true
#define NPH_LOBES true
#define NPH_SKY (skyKind() == kSkyNone ? 0 : params.skySize.w != 0 ? 1 : 2)
#define NPH_OPEN (params.skySize.z == kOpenParts)
#include "shaders/shared/emission.glsl"
#include "shaders/shared/environment.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/light_cache.glsl"
#include "shaders/shared/light_cache_fill.glsl"
#include "shaders/shared/walk.glsl"
// After the walk, whose types it takes.
#include "shaders/shared/march.glsl"
// After the march, likewise.
#include "shaders/shared/dda.glsl"
#include "shaders/shared/stage_shapes.glsl"
// After its shapes.
#include "shaders/shared/stage.glsl"
#undef NPH_CACHED
#undef NPH_EMISSION
#undef NPH_CHECK
#undef NPH_LEVELS
#undef NPH_GREY
#undef NPH_MAP
#undef NPH_SHOWN_SKY
#undef NPH_NEAR
#undef NPH_POINTS
#undef NPH_POWDER
#undef NPH_LOBES
#undef NPH_SKY
#undef NPH_OPEN
};

/// A source without a light cache and temperatures, for marches whose parameters ask for none.
struct NoCache {
  uint block(ivec3) const { return 0u; }
  float column(vec3) const { return 0.0f; }
  vec4 sky(int, vec3) const { return vec4(0.0f); }
  uvec2 heatWord(ivec3) const { return uvec2(0u); }
  float heatValue(uvec2, vec3, ivec3) const { return 0.0f; }
};

}  // namespace nephele::shared
