// Entry point of the rebuild's second stage: whole units become the atlas's densities, a brick with its apron a work group. Bricks
// without density are left as they are: nobody reads them.
#version 450 core
#include "live_grid.glsl"

const int kBrickSamples = 9;

layout(local_size_x = kBrickSamples * kBrickSamples) in;
layout(std430, binding = 2) readonly buffer Sums { uint sums[]; };
layout(std430, binding = 3) readonly buffer Corners { ivec4 corners[]; };  // of each brick in the atlas, texels
layout(std430, binding = 4) buffer Largest { uint largest[]; };            // sample of each brick, units
layout(binding = 0, r32f) writeonly uniform image3D atlas;

shared uint largestHere;

uint sumAt(ivec3 voxel) {
  if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, gridSize.xyz))) return 0u;
  return sums[(voxel.z * gridSize.y + voxel.y) * gridSize.x + voxel.x];
}

void main() {
  ivec3 brick = ivec3(gl_WorkGroupID);
  int number = (brick.z * gridBricks.y + brick.y) * gridBricks.x + brick.x;
  ivec3 column = ivec3(gl_LocalInvocationIndex % kBrickSamples, gl_LocalInvocationIndex / kBrickSamples, 0);
  ivec3 first = brick * (kBrickSamples - 1) + gridOffset.xyz + column;
  if (gl_LocalInvocationIndex == 0u) largestHere = 0u;
  barrier();
  uint values[kBrickSamples];
  uint own = 0u;
  for (int z = 0; z < kBrickSamples; ++z) {
    values[z] = sumAt(first + ivec3(0, 0, z));
    own = max(own, values[z]);
  }
  if (own > 0u) atomicMax(largestHere, own);
  barrier();
  if (gl_LocalInvocationIndex == 0u) largest[number] = largestHere;
  if (largestHere == 0u) return;
  ivec3 texel = corners[number].xyz + column;
  for (int z = 0; z < kBrickSamples; ++z)
    imageStore(atlas, texel + ivec3(0, 0, z), vec4(float(values[z]) * gridUnits.y));
}
