// Entry point of the march and of the methods beside it (NPH_METHOD 0: march, 1: cube, over 3: nothing, 2: dda): binds parameters and bricks,
// calls the shared text, writes one sample of each pixel.
// Row 0 of the target is the picture's top. Blending sums samples; the second target's alpha counts them.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };
layout(binding = 4) uniform sampler2D jitterTile;
layout(location = 0) uniform vec2 subPixel;
layout(location = 1) uniform uint sampleNumber;
#if NPH_METHOD == 1
layout(location = 0) in vec3 faceCoordinate;
#endif

layout(location = 0) out vec4 outRadiance;       // radiance, alpha
layout(location = 1) out vec4 outTransmittance;  // transmittance, 1
layout(location = 2) out vec4 outDepth;          // weighted depth, its weight, densities read, rays cut short

#include "bricks.glsl"
#if NPH_CHECK
layout(std430, binding = 3) buffer Skips { uint checked; uint wrong; };  // see walk.glsl
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
#if NPH_HEAT
#include "heat.glsl"
#include "shared/emission.glsl"
#define NPH_EMISSION true
#else
#define NPH_EMISSION false
vec3 emissionAt(vec3 position) { return vec3(0.0); }
#endif
#include "shared/light_cache.glsl"
#include "shared/environment.glsl"
#include "shared/light.glsl"
#include "shared/march.glsl"
#include "shared/dda.glsl"
#if NPH_STAGE
#include "shared/stage_shapes.glsl"
#include "shared/stage.glsl"
#endif

#if NPH_METHOD == 1
// From the camera through the place on the bounding cube that the raster interpolated.
Ray rayFromFace() {
  Ray r;
  vec3 camera = params.originCorner.xyz - params.originCorner.w * params.directionCorner.xyz;
  r.origin = mix(params.boxMin.xyz, params.boxMax.xyz, faceCoordinate);
  vec3 way = r.origin - camera;
  vec3 world = way.x * params.worldFromIndexX.xyz + way.y * params.worldFromIndexY.xyz + way.z * params.worldFromIndexZ.xyz;
  r.before = length(world);
  r.ray = world / r.before;
  r.direction = way / r.before;
  r.reach = 3.0e38f;
  return r;
}
#endif

#if NPH_VIEW
#include "view.glsl"
#else
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint random = randomState(uint(pixel.x), uint(pixel.y), 0u, uint(params.brickCount.w));
  float jitter = texelFetch(jitterTile, pixel & ivec2(kJitterTile - 1), 0).r;
#if NPH_METHOD == 1
  MarchResult result = marchAlong(rayFromFace(), stepStart(jitter, sampleNumber), random, sampleNumber);
#elif NPH_METHOD == 3
  MarchResult result = nothingMarched();
#elif NPH_METHOD == 2
  MarchResult result = walkVoxels(rayThrough(vec2(pixel) + subPixel), random, sampleNumber);
#elif NPH_STAGE
  MarchResult result = stageAlong(rayThrough(vec2(pixel) + subPixel), stepStart(jitter, sampleNumber), random, sampleNumber);
#else
  MarchResult result = marchRay(vec2(pixel) + subPixel, stepStart(jitter, sampleNumber), random, sampleNumber);
#endif
  vec3 behind = environmentBehind(vec2(pixel) + subPixel, result.opticalDepth);
  vec3 transmittance = exp(-result.opticalDepth);
  // Of what is hidden, not of what is left: a driver's third of 1, three times, may be more than 1.
  outRadiance = vec4(result.radiance + behind, dot(vec3(1.0) - transmittance, vec3(1.0 / 3.0)));
#if NPH_METHOD == 1
  // Every pixel has a sample without medium already.
  outRadiance.rgb -= environmentBehind(vec2(pixel) + subPixel, vec3(0.0));
  outTransmittance = vec4(transmittance - 1.0, 0.0);
#else
  outTransmittance = vec4(transmittance, 1.0);
#endif
#if NPH_CHECK
  atomicAdd(checked, uint(result.cost.z));
  atomicAdd(wrong, uint(result.cost.w));
#endif
  outDepth = vec4(result.depth, result.depthWeight, result.cost.x, result.cost.y);
}
#endif
