// Radiance of the environment by direction, and directions drawn from a lat-long picture [MODEL.md, section 2]. Included at
// GLSL's global scope, and in C++ inside a struct, after parameters.glsl, phase.glsl and random.glsl; the scope provides
//   MarchParameters params;
//   vec3 environmentTexel(ivec2 texel);   of the lat-long picture, row 0 at the top
//   vec4 environmentCell(int cell);       of its table (scene/environment_map.h)
// Some drivers run the branches that no pixel takes: NPH_MAP and NPH_SHOWN_SKY are true where there may be such a picture, and
// where the environment may be shown behind the medium.

// As in scene/environment_map.h: cells around, and up; the upper 15 bits of an integer choose one of all.
NPH_CONST int kSkyCellsAround = 256;
NPH_CONST int kSkyCellsUp = 128;
NPH_CONST uint kSkyCellShift = 17u;

NPH_FN int skyKind() { return int(params.skyUp.w); }

// The angle of (x, y) from the x axis, in (−π, π], within 5e-7; 0 for (0, 0). Drivers' own differ by 1e-4. The series of the
// arc tangent up to t^13, for |t| ≤ tan(π/8), after a turn by π/4.
NPH_FN float angleOf(float y, float x) {
  float large = max(abs(x), abs(y));
  float small = min(abs(x), abs(y));
  if (large <= 0.0f) return 0.0f;
  bool turned = small > 0.41421356f * large;
  float t = turned ? (small - large) / (small + large) : small / large;
  float s = t * t;
  float series = 1.0f / 11.0f - s * (1.0f / 13.0f);
  series = 1.0f / 9.0f - s * series;
  series = 1.0f / 7.0f - s * series;
  series = 1.0f / 5.0f - s * series;
  series = 1.0f / 3.0f - s * series;
  float angle = t - t * s * series + (turned ? 0.25f * kPi : 0.0f);
  if (abs(y) > abs(x)) angle = 0.5f * kPi - angle;
  if (x < 0.0f) angle = kPi - angle;
  return y < 0.0f ? -angle : angle;
}

// Neyret's ramp at the sine of an elevation: the horizon's colour fades into the zenith's above, into the ground's below.
NPH_FN vec3 rampRadiance(float sine) {
  bool above = sine >= 0.0f;
  vec3 far = above ? vec3(params.environment) : vec3(params.skyGround);
  float share = pow(1.0f - min(abs(sine), 1.0f), above ? params.skyHorizon.w : params.skyGround.w);
  return far + share * (vec3(params.skyHorizon) - far);
}

// Azimuth from where the centre column looks, to the right.
NPH_FN float skyAzimuth(vec3 direction) {
  return angleOf(dot(direction, vec3(params.skyRight)), dot(direction, vec3(params.skyForward)));
}

// The lat-long picture: bilinear between texel centres, around in azimuth, held at the poles.
NPH_FN vec3 mapRadiance(vec3 direction) {
  float sine = dot(direction, vec3(params.skyUp));
  vec3 level = direction - sine * vec3(params.skyUp);
  ivec2 size = ivec2(params.skySize.x, params.skySize.y);
  float x = (0.5f + skyAzimuth(direction) / (2.0f * kPi)) * float(size.x) - 0.5f;
  float y = angleOf(length(level), sine) / kPi * float(size.y) - 0.5f;
  float left = floor(x);
  float above = floor(y);
  float fx = x - left;
  float fy = y - above;
  int x0 = (int(left) + size.x) % size.x;
  int x1 = (int(left) + 1) % size.x;
  int y0 = clamp(int(above), 0, size.y - 1);
  int y1 = clamp(int(above) + 1, 0, size.y - 1);
  vec3 upper = mix(environmentTexel(ivec2(x0, y0)), environmentTexel(ivec2(x1, y0)), fx);
  vec3 lower = mix(environmentTexel(ivec2(x0, y1)), environmentTexel(ivec2(x1, y1)), fx);
  return vec3(params.environment) * mix(upper, lower, fy);
}

// Radiance that arrives from `direction`, unit, in world axes.
NPH_FN vec3 environmentRadiance(vec3 direction) {
  int kind = skyKind();
  if (kind == kSkyRamp) return rampRadiance(dot(direction, vec3(params.skyUp)));
  if (NPH_MAP && kind == kSkyMap) return mapRadiance(direction);
  return vec3(params.environment);
}

// Density per steradian with which drawFromMap draws a direction.
NPH_FN float mapDensity(vec3 direction) {
  float sine = clamp(dot(direction, vec3(params.skyUp)), -1.0f, 1.0f);
  int column = int((0.5f + skyAzimuth(direction) / (2.0f * kPi)) * float(kSkyCellsAround));
  int row = int((0.5f - 0.5f * sine) * float(kSkyCellsUp));
  int cell = min(row, kSkyCellsUp - 1) * kSkyCellsAround + clamp(column, 0, kSkyCellsAround - 1);
  return environmentCell(cell).z;
}

// A direction drawn by the map's brightness: `bits` chooses the cell, u1 and u2 the place in it.
NPH_FN vec3 drawFromMap(uint bits, float u1, float u2) {
  int cell = int(bits >> kSkyCellShift);
  float keep = float(bits & 0x1ffffu) * (1.0f / 131072.0f);  // the 17 bits that are left
  vec4 row = environmentCell(cell);
  if (keep >= row.x) cell = int(row.y);
  float azimuth = ((float(cell % kSkyCellsAround) + u1) / float(kSkyCellsAround) - 0.5f) * 2.0f * kPi;
  float sine = 1.0f - 2.0f * (float(cell / kSkyCellsAround) + u2) / float(kSkyCellsUp);
  float cosine = sqrt(max(0.0f, 1.0f - sine * sine));
  return cosine * (sin(azimuth) * vec3(params.skyRight) + cos(azimuth) * vec3(params.skyForward)) +
         sine * vec3(params.skyUp);
}

// What the picture holds of the environment along the ray at picture position `at`, seen through `opticalDepth`: 0 where the
// scene does not ask to show it.
NPH_FN vec3 environmentBehind(vec2 at, vec3 opticalDepth) {
  if (!NPH_SHOWN_SKY || params.skyForward.w <= 0.0f || skyKind() == kSkyNone) return vec3(0.0f);
  vec3 ray = vec3(params.rayCorner) + at.x * vec3(params.rayDx) + at.y * vec3(params.rayDy);
  return exp(-opticalDepth) * environmentRadiance(normalize(ray));
}
