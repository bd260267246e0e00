// Entry point of the light cache: fills the samples of the blocks from `firstBlock` on, one block a work group in x.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(local_size_x = 32) in;
layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };
layout(std430, binding = 1) readonly buffer Blocks { ivec4 blocks[]; };  // those kept, in order of their places
layout(std430, binding = 2) buffer Cost { uint densitiesRead; uint checked; uint wrong; };  // the last two: see walk.glsl
#if NPH_CACHE_FLOAT
layout(binding = 0, r32f) writeonly uniform image3D columns;
layout(binding = 1, rgba32f) writeonly uniform image3D skyImage;
#else
#if NPH_COLUMN_BYTES
layout(binding = 0, r8) writeonly uniform image3D columns;
#else
layout(binding = 0, r16f) writeonly uniform image3D columns;
#endif
layout(binding = 1, rgb10_a2) writeonly uniform image3D skyImage;
#endif
layout(location = 0) uniform uint firstBlock;
layout(location = 1) uniform int light;  // −1: the sky

#define NPH_CACHED false  // nothing is scattered here
#define NPH_SKY 0
#define NPH_OPEN (params.skySize.z == kOpenParts)
#define NPH_GREY false
#define NPH_MAP false  // marched for
#define NPH_SHOWN_SKY false
#define NPH_NEAR false
#define NPH_POINTS true
#define NPH_POWDER false
#define NPH_LOBES true
#include "bricks.glsl"
#include "sky.glsl"
#include "shared/chord.glsl"
#include "shared/phase.glsl"
#include "shared/random.glsl"
#include "shared/ray_box.glsl"
#include "shared/remap.glsl"
#include "shared/powder.glsl"
#include "shared/step_integral.glsl"
#include "shared/walk.glsl"
#include "shared/light_cache.glsl"
#include "shared/environment.glsl"
#include "shared/light.glsl"
#include "shared/light_cache_fill.glsl"

void main() {
  ivec3 block = blocks[firstBlock + gl_WorkGroupID.x].xyz;
  int samples = light < 0 ? params.cacheShape.y : params.cacheShape.x;
  int i = int(gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
  if (i >= samples * samples * samples) return;
  ivec3 local = ivec3(i % samples, i / samples % samples, i / (samples * samples));
  vec3 position = cachePosition(block, local, samples);
  uint place = blockWord(block) - 1u;
  ivec3 texel = samples * ivec3(place & 1023u, (place >> 10u) & 1023u, place >> 20u) + local;
  vec4 cost = vec4(0.0);
  if (light < 0) {
    vec4 sky0;
    vec4 sky1;
    vec4 open;
    skyToCache(position, skyTurn(block, local, samples), sky0, sky1, open, cost);
    ivec3 part = ivec3(0, 0, imageSize(skyImage).z / params.skySize.z);
    imageStore(skyImage, texel, sky0);
    imageStore(skyImage, texel + part, sky1);
    if (NPH_OPEN) imageStore(skyImage, texel + 2 * part, open);
  } else {
    imageStore(columns, texel + ivec3(0, 0, light * params.cacheShape.z), vec4(columnToCache(light, position, cost)));
  }
  atomicAdd(densitiesRead, uint(cost.x));
  atomicAdd(checked, uint(cost.z));
  atomicAdd(wrong, uint(cost.w));
}
