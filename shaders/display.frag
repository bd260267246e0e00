// Shows a film in the window: means over samples, the backdrop or the environment behind, the project's tone curve; or one
// quantity as colours of a scale. NPH_SHOWN says which (preview/app/views.h), NPH_BEHIND what stands behind the medium
// (preview/behind.h): some drivers run the branches that no pixel takes. The curve is that of base/picture.h:
// y = 1 − e^(−x · 2^EV), then the sRGB transfer function.
#version 450 core
#include "dialect.glsl"
#include "shared/parameters.glsl"

layout(std140, binding = 0) uniform MarchBlock { MarchParameters params; };  // for a picture of the window's size
layout(binding = 0) uniform sampler2D radianceSum;
layout(binding = 1) uniform sampler2D transmittanceSum;
layout(binding = 2) uniform sampler2D depthSum;
layout(location = 0) uniform vec3 backdropBottom;
layout(location = 1) uniform vec3 backdropTop;
layout(location = 3) uniform vec2 windowSize;
layout(location = 4) uniform float exposure;  // 2^EV
layout(location = 7) uniform float scale;  // upper end of the view's scale

layout(location = 0) out vec4 outColour;

#define NPH_SHOWN_SKY true
#include "sky.glsl"
#include "shared/phase.glsl"
#include "shared/random.glsl"
#include "shared/environment.glsl"

// As preview/behind.h numbers them; with anything else the film holds the environment already.
#define BACKDROP 0
#define SKY 1

#define RADIANCE 0
#define TRANSMITTANCE 1
#define OPTICAL_DEPTH 2
#define STEPS 4

const vec3 kGround = vec3(0.012);  // behind a scale's colours, linear

vec3 srgbFromLinear(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}

// Dark blue over red to pale yellow, lightness rising throughout; [0, 1] → sRGB. Six colours, mixed linearly.
vec3 scaleColour(float x) {
  const vec3 stops[6] = vec3[6](vec3(0.02, 0.02, 0.10), vec3(0.27, 0.07, 0.44), vec3(0.60, 0.16, 0.46),
                                vec3(0.90, 0.32, 0.34), vec3(0.99, 0.64, 0.38), vec3(0.99, 0.98, 0.76));
  float place = clamp(x, 0.0, 1.0) * 5.0;
  int i = min(int(place), 4);
  return mix(stops[i], stops[i + 1], place - float(i));
}

vec3 radianceColour(vec4 radiance, vec4 transmittance, float count, vec2 uv) {
  vec3 colour = radiance.rgb / count * exposure;
#if NPH_BEHIND == SKY
  vec2 at = uv * windowSize;
  vec3 ray = params.rayCorner.xyz + at.x * params.rayDx.xyz + at.y * params.rayDy.xyz;
  colour += transmittance.rgb / count * environmentRadiance(normalize(ray)) * exposure;
#elif NPH_BEHIND == BACKDROP
  // The backdrop is no light, and exposure does not change it.
  colour += (1.0 - radiance.a / count) * mix(backdropTop, backdropBottom, uv.y);
#endif
  return srgbFromLinear(1.0 - exp(-max(colour, 0.0)));
}

void main() {
  // The film's first row is the picture's top, the window's first row its bottom.
  vec2 uv = vec2(gl_FragCoord.x, windowSize.y - gl_FragCoord.y) / windowSize;
  vec4 radiance = texture(radianceSum, uv);
  vec4 transmittance = texture(transmittanceSum, uv);
  float count = max(transmittance.a, 1.0);
  vec3 colour = vec3(0.0);
#if NPH_SHOWN == RADIANCE
  colour = radianceColour(radiance, transmittance, count, uv);
#elif NPH_SHOWN == TRANSMITTANCE
  colour = srgbFromLinear(clamp(transmittance.rgb / count, 0.0, 1.0));
#elif NPH_SHOWN == OPTICAL_DEPTH
  vec3 t = clamp(transmittance.rgb / count, exp(-scale), 1.0);
  colour = scaleColour(-log((t.r + t.g + t.b) / 3.0) / scale);
#elif NPH_SHOWN == STEPS
  colour = scaleColour(texture(depthSum, uv).z / count / scale);
#else  // the slice and the skipped share hold value · weight, and the weight
  float weight = radiance.a / count;
  vec3 inside = scaleColour(radiance.r / max(radiance.a, 1e-6) / scale);
  colour = mix(srgbFromLinear(kGround), inside, weight);
#endif
  outColour = vec4(colour, 1.0);
}
