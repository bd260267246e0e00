// Entry point of the march: binds parameters and bricks, calls the shared marchRay, writes one sample of each pixel.
// Row 0 of the target is the picture's top. Blending sums samples; the second target's alpha counts them.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };
layout(binding = 0) uniform sampler3D atlas;        // bricks of 9³ samples
layout(binding = 1) uniform usampler3D brickIndex;  // 0, or the brick's place in the atlas: 8 bits an axis, and bit 24
layout(location = 0) uniform vec2 subPixel;
layout(location = 1) uniform uint sampleNumber;
layout(location = 2) uniform vec3 texelSize;  // 1 / the atlas's size

layout(location = 0) out vec4 outRadiance;       // radiance, alpha
layout(location = 1) out vec4 outTransmittance;  // transmittance, 1
layout(location = 2) out vec4 outDepth;          // weighted depth, its weight, densities read, rays cut short

const int kBrickSamples = 9;

ivec3 atlasCorner(uint place) {
  return kBrickSamples * ivec3(place & 255u, (place >> 8u) & 255u, (place >> 16u) & 255u);
}

uint brickSlot(ivec3 brick) { return texelFetch(brickIndex, brick, 0).r; }

#if NPH_FILTER_EXACT
float brickDensity(uint slot, vec3 position) {
  // A position a hair below 0 rounds to the far face of the brick before: hence the upper bound.
  ivec3 cell = min(ivec3(floor(position)), ivec3(kBrickSamples - 2));
  vec3 f = position - vec3(cell);
  ivec3 t = atlasCorner(slot) + cell;
  float s000 = texelFetch(atlas, t, 0).r;
  float s100 = texelFetch(atlas, t + ivec3(1, 0, 0), 0).r;
  float s010 = texelFetch(atlas, t + ivec3(0, 1, 0), 0).r;
  float s110 = texelFetch(atlas, t + ivec3(1, 1, 0), 0).r;
  float s001 = texelFetch(atlas, t + ivec3(0, 0, 1), 0).r;
  float s101 = texelFetch(atlas, t + ivec3(1, 0, 1), 0).r;
  float s011 = texelFetch(atlas, t + ivec3(0, 1, 1), 0).r;
  float s111 = texelFetch(atlas, t + ivec3(1, 1, 1), 0).r;
  float y0 = mix(mix(s000, s100, f.x), mix(s010, s110, f.x), f.y);
  float y1 = mix(mix(s001, s101, f.x), mix(s011, s111, f.x), f.y);
  return mix(y0, y1, f.z);
}
#else
float brickDensity(uint slot, vec3 position) {
  // A texel's centre lies at its index plus a half.
  return textureLod(atlas, (vec3(atlasCorner(slot)) + position + 0.5) * texelSize, 0.0).r;
}
#endif

#include "sky.glsl"
#include "shared/chord.glsl"
#include "shared/phase.glsl"
#include "shared/random.glsl"
#include "shared/ray_box.glsl"
#include "shared/remap.glsl"
#include "shared/powder.glsl"
#include "shared/step_integral.glsl"
#include "shared/walk.glsl"
#include "shared/environment.glsl"
#include "shared/light.glsl"
#include "shared/march.glsl"

#if NPH_VIEW
#include "view.glsl"
#else
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint random = randomState(uint(pixel.x), uint(pixel.y), sampleNumber, uint(params.brickCount.w));
  MarchResult result = marchRay(vec2(pixel) + subPixel, random, sampleNumber);
  vec3 behind = environmentBehind(vec2(pixel) + subPixel, result.opticalDepth);
  vec3 transmittance = exp(-result.opticalDepth);
  outRadiance = vec4(result.radiance + behind, 1.0 - (transmittance.r + transmittance.g + transmittance.b) / 3.0);
  outTransmittance = vec4(transmittance, 1.0);
  outDepth = vec4(result.depth, result.depthWeight, result.cost.x, result.cost.y);
}
#endif
