// Entry point of the rebuild's last stage: each brick's words of the index, as volume/brick_layout.h says, from its largest sample.
#version 450 core
#include "live_grid.glsl"

layout(local_size_x = 32) in;
layout(std430, binding = 3) readonly buffer Corners { ivec4 corners[]; };
layout(std430, binding = 4) readonly buffer Largest { uint largest[]; };
layout(binding = 1, rg32ui) writeonly uniform uimage2D index;

// Codes of maxima are floats cut down to 5 bits of exponent and 3 of mantissa.
const uint kLeastBits = 0x30000000u;
const uint kCodeStep = 1u << 20u;
const int kMostLevel = 3;  // of empty cubes

uint largestOf(ivec3 brick) { return largest[(brick.z * gridBricks.y + brick.y) * gridBricks.x + brick.x]; }

// The level of the largest aligned cube of empty bricks round an empty one.
uint emptyLevel(ivec3 brick) {
  int level = 0;
  for (; level < kMostLevel; ++level) {
    int edge = 2 << level;
    ivec3 low = brick - (brick & ivec3(edge - 1));
    ivec3 high = min(low + edge, gridBricks.xyz);
    uint found = 0u;
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) found |= largestOf(ivec3(x, y, z));
    if (found != 0u) break;
  }
  return uint(level);
}

// The least code of volume/brick_bounds.h whose bound, as walk.glsl computes it, a density does not exceed.
uint maximumCode(float density) {
  uint bits = max(floatBitsToUint(density / gridBound.x), kLeastBits);
  uint code = max((bits - kLeastBits + kCodeStep - 1u) / kCodeStep, 1u);
  if (gridBound.x * uintBitsToFloat(code * kCodeStep + kLeastBits) < density) ++code;
  return code;
}

void main() {
  int number = int(gl_GlobalInvocationID.x);
  if (number >= gridBricks.w) return;
  ivec3 brick = ivec3(number % gridBricks.x, number / gridBricks.x % gridBricks.y, number / (gridBricks.x * gridBricks.y));
  uint units = largest[number];
  uvec3 corner = uvec3(corners[number].xyz);
  uvec2 word = units == 0u ? uvec2(0u, emptyLevel(brick))
                           : uvec2(corner.x | (corner.y << 12u) | (maximumCode(float(units) * gridUnits.y) << 24u), corner.z);
  int width = imageSize(index).x;  // a power of two
  imageStore(index, ivec2(number & (width - 1), number >> findMSB(width)), uvec4(word, 0u, 0u));
}
