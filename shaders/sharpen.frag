// Makes a small film ready for being shown larger, linearly between its pixels: linear mixing blurs, and this adds beforehand
// what it will take away. Each sum less the mean of its four neighbours is added once more by kShare. Reads one film, writes
// another.
#version 450 core

layout(binding = 0) uniform sampler2D radianceSum;
layout(binding = 1) uniform sampler2D transmittanceSum;
layout(binding = 2) uniform sampler2D depthSum;

layout(location = 0) out vec4 outRadiance;
layout(location = 1) out vec4 outTransmittance;
layout(location = 2) out vec4 outDepth;

// Between 1/4 and 1/2 an enlargement by two comes as near to the large picture as cubic splines through all pixels do.
const float kShare = 0.375;

vec4 sharpened(sampler2D sums, ivec2 pixel) {
  ivec2 last = textureSize(sums, 0) - 1;
  vec4 around = texelFetch(sums, ivec2(max(pixel.x - 1, 0), pixel.y), 0) +
                texelFetch(sums, ivec2(min(pixel.x + 1, last.x), pixel.y), 0) +
                texelFetch(sums, ivec2(pixel.x, max(pixel.y - 1, 0)), 0) +
                texelFetch(sums, ivec2(pixel.x, min(pixel.y + 1, last.y)), 0);
  vec4 centre = texelFetch(sums, pixel, 0);
  return centre + kShare * (centre - 0.25 * around);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 radiance = max(sharpened(radianceSum, pixel), 0.0);
  vec4 transmittance = sharpened(transmittanceSum, pixel);
  // Alphas and transmittances stay shares of the samples' count.
  float count = transmittance.a;
  outRadiance = vec4(radiance.rgb, min(radiance.a, count));
  outTransmittance = vec4(clamp(transmittance.rgb, 0.0, count), count);
  outDepth = texelFetch(depthSum, pixel, 0);
}
