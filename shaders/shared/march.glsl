// The march: view transmittance and in-scattered radiance along one ray, by fixed steps over a grid of bricks
// [MODEL.md, section 2]. Included at GLSL's global scope, and in C++ inside a struct, which provide
//   MarchParameters params;
//   uint brickSlot(ivec3 brick);                    0: no density in the brick, which lies inside the brick grid
//   float brickDensity(uint slot, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in voxels

NPH_CONST float kBrickEdge = 8.0f;
// Neighbouring steps are lit together, from their centre of weight, until they take this share of the view or are this many:
// light is by far the dearest, and within them it changes by little. Both vanish as steps do.
NPH_CONST float kLitTogetherShare = 0.02f;
NPH_CONST int kLitTogetherSteps = 4;

struct MarchResult {
  vec3 radiance;       // scattered towards the camera
  vec3 opticalDepth;   // of the whole ray, or up to where it was given up, per channel
  float depth;         // world distance from the camera, weighted by what each step takes from the view; 0 without medium
  float depthWeight;   // that weight's sum: 1 − transmittance, mean over channels
  vec2 cost;           // x: densities read: view, shadow and sky. y: 1 where a driver ended a loop before its time
};

// Density at an index-space position. Where its brick is empty, `toExit` becomes the number of `stride`s from there to the
// brick's far face, over which all densities are 0; otherwise it is 0.
NPH_FN float densityAndExit(vec3 position, vec3 stride, NPH_OUT(float) toExit) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  toExit = 0.0f;
  bool outside = brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.brickCount.x ||
                 brick.y >= params.brickCount.y || brick.z >= params.brickCount.z;
  // Rounding may place an end of the ray a hair outside the box, where the density is 0.
  if (outside) return 0.0f;
  uint slot = brickSlot(brick);
  vec3 corner = vec3(brick) * kBrickEdge;
  if (slot != 0u) return brickDensity(slot, position - corner);
  toExit = 1e9f;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(stride[axis]) > 1e-9f) {
      float face = stride[axis] > 0.0f ? corner[axis] + kBrickEdge : corner[axis];
      toExit = min(toExit, (face - position[axis]) / stride[axis]);
    }
  }
  return 0.0f;
}

// ∫ ρ ds in world units from `origin` along `direction` (index units per world unit) over at most `reach` world units, by
// steps that grow with the way gone: what lies far from a point shades its neighbours alike. Empty bricks are passed without
// reading them, on the same steps. Gives up, with what it has, once it exceeds `enough`.
NPH_FN float columnDensity(vec3 origin, vec3 direction, float reach, float enough, float start,
                           NPH_INOUT(vec2) cost) {
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return 0.0f;
  tFar = min(tFar, reach);
  float dt = params.shadow.x / length(direction);
  float growth = params.shadow.y;
  float column = 0.0f;
  float t = tNear;
  // Kept apart from the loop's condition, which a compiler may take to be false behind the loop.
  float arrived = t < tFar ? 0.0f : 1.0f;
  while (t < tFar) {               // false also where t is NaN
    float ds = min(dt, tFar - t);  // the last step ends where the medium does
    float middle = t + start * ds;
    float toExit = 0.0f;
    column += densityAndExit(origin + middle * direction, direction, toExit) * ds;
    cost.x += 1.0f;
    arrived = column > enough ? 1.0f : 0.0f;
    if (column > enough) break;
    t += ds;
    dt *= growth;
    // Steps whose reading lies in the same empty brick, a thousandth of a step before its end at most.
    float end = min(middle + toExit, tFar) - 1e-3f * dt;
    while (t + start * dt < end) {
      t += dt;
      dt *= growth;
    }
    arrived = t < tFar ? 0.0f : 1.0f;
  }
  cost.y = max(cost.y, 1.0f - arrived);
  return column;
}

// Σ over orders of b^m · phase(c^m g) · e^(−a^m σ_t column), to be multiplied by σ_s and the light's irradiance.
NPH_FN vec3 scatteredByOrders(vec3 toLight, vec3 ray, float column) {
  vec3 sum = vec3(0.0f);
  float extinction = 1.0f;
  float scattering = 1.0f;
  float g = params.sigmaT.w;
  for (int m = 0; m <= params.counts.y; ++m) {
    sum += scattering * phaseHenyeyGreenstein(toLight, ray, g) * exp(-(extinction * column) * vec3(params.sigmaT));
    extinction *= params.octaves.x;
    scattering *= params.octaves.y;
    g *= params.octaves.z;
  }
  return sum;
}

// The column beyond which no order lets through more than the smallest transmittance worth following.
NPH_FN float columnThatHides() {
  float extinction = min(params.sigmaT.x, min(params.sigmaT.y, params.sigmaT.z));
  for (int m = 0; m < params.counts.y; ++m) extinction *= params.octaves.x;
  // 1e30: with no extinction nothing hides.
  return extinction > 0.0f ? min(-log(params.environment.w) / extinction, 1e30f) : 1e30f;
}

// A light or, beyond the last one, the sky, as seen from a point.
struct Lighting {
  vec3 toLight;       // unit, world axes
  vec3 toLightIndex;  // the same in voxels per world unit
  float reach;        // world distance to the light
  vec3 irradiance;    // for the sky: radiance over the density with which the direction was drawn
};

NPH_FN Lighting lightingFrom(int i, vec3 position) {
  Lighting l;
  l.toLight = vec3(params.lights[i].direction);
  l.toLightIndex = vec3(params.lights[i].directionIndex);
  l.reach = 3.0e38f;
  l.irradiance = vec3(params.lights[i].power);
  if (int(params.lights[i].direction.w) == kLightPoint) {
    vec3 apart = vec3(params.lights[i].directionIndex) - position;
    vec3 apartWorld = apart.x * vec3(params.worldFromIndexX) + apart.y * vec3(params.worldFromIndexY) +
                      apart.z * vec3(params.worldFromIndexZ);
    l.reach = max(length(apartWorld), 1e-15f);  // a sample on the light has no direction; its square stays a float
    l.toLight = apartWorld / l.reach;
    l.toLightIndex = apart / l.reach;
    l.irradiance /= l.reach * l.reach;
  }
  return l;
}

// One direction to the sky: half of them follow the phase function, half are uniform, so that the weight stays bounded for
// all orders. Neighbouring pixels look the same way, so that differences stay smooth; over the picture's samples the
// directions follow the additive recurrence of preview/gpu/sub_pixels.h, in integers.
NPH_FN Lighting lightingFromSky(vec3 ray, uint place, uint number) {
  uint rotation = randomState(place, 0u, 0u, uint(params.brickCount.w));
  float u1 = float((rotation + number * 3242174889u) >> 8u) * (1.0f / 16777216.0f);
  float u2 = float((hashBits(rotation) + number * 2447445414u) >> 8u) * (1.0f / 16777216.0f);
  bool byPhase = ((place + number) & 1u) == 0u;
  Lighting l;
  l.toLight = sampleHenyeyGreenstein(ray, byPhase ? params.sigmaT.w : 0.0f, u1, u2);
  l.toLightIndex = l.toLight.x * vec3(params.indexFromWorldX) + l.toLight.y * vec3(params.indexFromWorldY) +
                   l.toLight.z * vec3(params.indexFromWorldZ);
  l.reach = 3.0e38f;
  float density = 0.5f * phaseHenyeyGreenstein(l.toLight, ray, params.sigmaT.w) + 0.5f * phaseIsotropic();
  l.irradiance = vec3(params.environment) / density;
  return l;
}

// Source function at a point: Σ over lights and the sky, per unit density, before σ_s. `place` counts the points lit along
// the ray, `number` the picture's samples.
NPH_FN vec3 inScattering(vec3 position, vec3 ray, float enough, uint place, uint number, NPH_INOUT(uint) random,
                         NPH_INOUT(vec2) cost) {
  vec3 sum = vec3(0.0f);
  bool sky = max(params.environment.x, max(params.environment.y, params.environment.z)) > 0.0f;
  int count = params.counts.x + (sky ? 1 : 0);
  int done = 0;
  for (int i = 0; i < count; ++i) {
    float start = params.counts.w != 0 ? nextUniform(random) : 0.5f;
    Lighting l;
    if (i < params.counts.x) {
      l = lightingFrom(i, position);
    } else {
      l = lightingFromSky(ray, place, number);
    }
    float column = columnDensity(position, l.toLightIndex, l.reach, enough, start, cost);
    sum += l.irradiance * scatteredByOrders(l.toLight, ray, column);
    done += 1;
  }
  if (done < count) cost.y = 1.0f;
  return sum;
}

// One ray through picture position `at` (pixels from the top left corner); `random` is the pixel's own, `number` the sample's.
NPH_FN MarchResult marchRay(vec2 at, uint random, uint number) {
  MarchResult result;
  result.radiance = vec3(0.0f);
  result.opticalDepth = vec3(0.0f);
  result.depth = 0.0f;
  result.depthWeight = 0.0f;
  result.cost = vec2(0.0f);
  vec3 rayLong = vec3(params.rayCorner) + at.x * vec3(params.rayDx) + at.y * vec3(params.rayDy);
  float stretch = length(rayLong);
  vec3 ray = rayLong / stretch;
  vec3 origin = vec3(params.originCorner) + at.x * vec3(params.originDx) + at.y * vec3(params.originDy);
  vec3 direction = (vec3(params.directionCorner) + at.x * vec3(params.directionDx) + at.y * vec3(params.directionDy)) / stretch;
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return result;
  float dt = params.sigmaS.w / length(direction);
  vec3 stride = direction * dt;
  float start = params.counts.w != 0 ? nextUniform(random) : 0.5f;
  float enough = columnThatHides();
  vec3 share = vec3(0.0f);  // of the view, in the steps that wait to be lit: ∫ e^(−τ) ρ ds
  float place = 0.0f;       // its mean distance along the ray, times its mean over channels
  float waitingTaken = 0.0f;
  int waitingSteps = 0;
  uint lit = 0u;
  bool last = false;
  float arrived = 0.0f;  // 1 once `last` was seen; see columnDensity
  int steps = 1;
  for (int k = 0; !last; k += steps) {
    float t = tNear + float(k) * dt;
    last = !(t < tFar);  // also where t is NaN
    steps = 1;
    if (!last) {
      float ds = min(dt, tFar - t);
      float middle = t + start * ds;
      float toExit = 0.0f;
      float rho = densityAndExit(origin + middle * direction, stride, toExit);
      // Stop a thousandth of a step short: an extra sample in the empty brick costs little, a missed one would be wrong.
      steps = max(1, int(min(floor(toExit - 1e-3f), 1e6f)));
      result.cost.x += 1.0f;
      if (rho > 0.0f) {
        vec3 x = (rho * ds) * vec3(params.sigmaT);
        vec3 before = exp(-result.opticalDepth);
        vec3 weight = before * (rho * ds) * stepIntegral(x);
        share += weight;
        place += dot(weight, vec3(1.0f / 3.0f)) * middle;
        result.opticalDepth += x;
        vec3 left = exp(-result.opticalDepth);
        float taken = dot(before - left, vec3(1.0f / 3.0f));
        result.depth += taken * (params.originCorner.w * stretch + middle);
        result.depthWeight += taken;
        waitingTaken += taken;
        last = max(left.x, max(left.y, left.z)) < params.environment.w;
      }
      waitingSteps += steps;
    }
    float mean = dot(share, vec3(1.0f / 3.0f));
    if (mean > 0.0f && (last || waitingTaken >= kLitTogetherShare || waitingSteps >= kLitTogetherSteps)) {
      // Each place has numbers of its own, so that more or fewer drawn at another do not change them.
      uint placeRandom = hashBits(random ^ lit);
      vec3 position = origin + (place / mean) * direction;
      vec3 source = vec3(params.sigmaS) * inScattering(position, ray, enough, lit, number, placeRandom, result.cost);
      lit += 1u;
      result.radiance += source * share;
      share = vec3(0.0f);
      place = 0.0f;
      waitingTaken = 0.0f;
    }
    if (mean <= 0.0f || waitingTaken <= 0.0f) waitingSteps = 0;
    arrived = last ? 1.0f : 0.0f;
  }
  result.cost.y = max(result.cost.y, 1.0f - arrived);
  return result;
}
