// Shows a film in the window: means over samples, the backdrop or the environment behind, the project's tone curve.
// The curve is that of base/picture.h: y = 1 − e^(−x · 2^EV), then the sRGB transfer function.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };  // for a picture of the window's size
layout(binding = 0) uniform sampler2D radianceSum;
layout(binding = 1) uniform sampler2D transmittanceSum;
layout(location = 0) uniform vec3 backdropBottom;
layout(location = 1) uniform vec3 backdropTop;
layout(location = 3) uniform vec2 windowSize;
layout(location = 4) uniform float exposure;  // 2^EV
layout(location = 5) uniform int behind;  // what stands behind the medium: kBackdrop, kSky or kNothing

layout(location = 0) out vec4 outColour;

#include "sky.glsl"
#include "shared/phase.glsl"
#include "shared/random.glsl"
#include "shared/environment.glsl"

// As preview/behind.h numbers them; with anything else the film holds the environment already.
const int kBackdrop = 0;
const int kSky = 1;

vec3 srgbFromLinear(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}

void main() {
  // The film's first row is the picture's top, the window's first row its bottom.
  vec2 uv = vec2(gl_FragCoord.x, windowSize.y - gl_FragCoord.y) / windowSize;
  vec4 radiance = texture(radianceSum, uv);
  vec4 transmittance = texture(transmittanceSum, uv);
  float count = max(transmittance.a, 1.0);
  vec3 colour = radiance.rgb / count * exposure;
  if (behind == kSky) {
    vec2 at = uv * windowSize;
    vec3 ray = params.rayCorner.xyz + at.x * params.rayDx.xyz + at.y * params.rayDy.xyz;
    colour += transmittance.rgb / count * environmentRadiance(normalize(ray)) * exposure;
  } else if (behind == kBackdrop) {
    // The backdrop is no light, and exposure does not change it.
    colour += (1.0 - radiance.a / count) * mix(backdropTop, backdropBottom, uv.y);
  }
  outColour = vec4(srgbFromLinear(1.0 - exp(-max(colour, 0.0))), 1.0);
}
