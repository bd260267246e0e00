// Shows a film in the window: means over samples, the backdrop or the environment behind, the project's tone curve.
// The curve is that of base/picture.h: y = 1 − e^(−x · 2^EV), then the sRGB transfer function.
#version 450 core

layout(binding = 0) uniform sampler2D radianceSum;
layout(binding = 1) uniform sampler2D transmittanceSum;
layout(location = 0) uniform vec3 backdropBottom;
layout(location = 1) uniform vec3 backdropTop;
layout(location = 2) uniform vec3 environment;
layout(location = 3) uniform vec2 windowSize;
layout(location = 4) uniform float exposure;  // 2^EV
layout(location = 5) uniform int showEnvironment;

layout(location = 0) out vec4 outColour;

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
  if (showEnvironment != 0) {
    colour += transmittance.rgb / count * environment * exposure;
  } else {
    // The backdrop is no light, and exposure does not change it.
    colour += (1.0 - radiance.a / count) * mix(backdropTop, backdropBottom, uv.y);
  }
  outColour = vec4(srgbFromLinear(1.0 - exp(-max(colour, 0.0))), 1.0);
}
