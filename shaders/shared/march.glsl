// The march: view transmittance and in-scattered radiance along one ray, by fixed steps over a grid of bricks
// [MODEL.md, section 2]. Included at GLSL's global scope, and in C++ inside a struct, which provide
//   MarchParameters params;
//   uint brickSlot(ivec3 brick);                    0: no density in the brick, which lies inside the brick grid
//   float brickDensity(uint slot, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in voxels

NPH_CONST float kBrickEdge = 8.0f;

struct MarchResult {
  vec3 radiance;       // scattered towards the camera
  vec3 opticalDepth;   // of the whole ray, or up to where it was given up, per channel
  float depth;         // world distance from the camera, weighted by what each step takes from the view; 0 without medium
  float depthWeight;   // that weight's sum: 1 − transmittance, mean over channels
  float samples;       // densities read: view, shadow and sky
};

// Density at an index-space position; `steps` becomes the number of steps of `stride` (index units for a step) that may be
// taken at once: 1, or more where all samples passed over lie in the same empty brick, so that skipping changes nothing.
NPH_FN float densityAndSkip(vec3 position, vec3 stride, NPH_OUT(int) steps) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  steps = 1;
  bool outside = brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.brickCount.x ||
                 brick.y >= params.brickCount.y || brick.z >= params.brickCount.z;
  // Rounding may place an end of the ray a hair outside the box, where the density is 0.
  if (outside) return 0.0f;
  uint slot = brickSlot(brick);
  vec3 corner = vec3(brick) * kBrickEdge;
  if (slot != 0u) return brickDensity(slot, position - corner);
  float toExit = 1e9f;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(stride[axis]) > 1e-9f) {
      float face = stride[axis] > 0.0f ? corner[axis] + kBrickEdge : corner[axis];
      toExit = min(toExit, (face - position[axis]) / stride[axis]);
    }
  }
  // Stop a thousandth of a step short: an extra sample in the empty brick costs little, a missed one would be wrong.
  steps = max(1, int(min(floor(toExit - 1e-3f), 1e6f)));
  return 0.0f;
}

// ∫ ρ ds in world units from `origin` along `direction` (index units per world unit) over at most `reach` world units.
// Gives up, with what it has, once it exceeds `enough`.
NPH_FN float columnDensity(vec3 origin, vec3 direction, float reach, float enough, float start,
                           NPH_INOUT(float) samples) {
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, params.boxMin.xyz, params.boxMax.xyz, tNear, tFar)) return 0.0f;
  tFar = min(tFar, reach);
  float dt = params.octaves.w / length(direction);
  vec3 stride = direction * dt;
  float column = 0.0f;
  int steps = 1;
  // An int counts steps: a float would stop counting at 2^24.
  for (int k = 0;; k += steps) {
    float t = tNear + (float(k) + start) * dt;
    if (!(t < tFar)) break;  // also where t is NaN
    column += densityAndSkip(origin + t * direction, stride, steps) * dt;
    samples += 1.0f;
    if (column > enough) break;
  }
  return column;
}

// Σ over orders of b^m · phase(c^m g) · e^(−a^m σ_t column), to be multiplied by σ_s and the light's irradiance.
NPH_FN vec3 scatteredByOrders(vec3 toLight, vec3 ray, float column) {
  vec3 sum = vec3(0.0f);
  float extinction = 1.0f;
  float scattering = 1.0f;
  float g = params.sigmaT.w;
  for (int m = 0; m <= params.counts.y; ++m) {
    sum += scattering * phaseHenyeyGreenstein(toLight, ray, g) * exp(-(extinction * column) * params.sigmaT.xyz);
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

// Source function at a point: Σ over lights, and the sky by one random direction, per unit density, before σ_s.
NPH_FN vec3 inScattering(vec3 position, vec3 ray, float enough, NPH_INOUT(uint) random, NPH_INOUT(float) samples) {
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < params.counts.x; ++i) {
    float start = params.counts.w != 0 ? nextUniform(random) : 0.5f;
    vec3 toLight = params.lights[i].direction.xyz;
    vec3 toLightIndex = params.lights[i].directionIndex.xyz;
    vec3 irradiance = params.lights[i].power.xyz;
    float reach = 3.0e38f;
    if (int(params.lights[i].direction.w) == kLightPoint) {
      vec3 apart = params.lights[i].directionIndex.xyz - position;
      vec3 apartWorld = apart.x * params.worldFromIndexX.xyz + apart.y * params.worldFromIndexY.xyz +
                        apart.z * params.worldFromIndexZ.xyz;
      reach = max(length(apartWorld), 1e-20f);  // a sample on the light itself has no direction
      toLight = apartWorld / reach;
      toLightIndex = apart / reach;
      irradiance /= reach * reach;
    }
    float column = columnDensity(position, toLightIndex, reach, enough, start, samples);
    sum += irradiance * scatteredByOrders(toLight, ray, column);
  }
  if (max(params.environment.x, max(params.environment.y, params.environment.z)) > 0.0f) {
    // Half the directions follow the phase function, half are uniform: the weight stays bounded for all orders.
    float choice = nextUniform(random);
    float u1 = nextUniform(random);
    float u2 = nextUniform(random);
    float start = nextUniform(random);
    vec3 toSky = sampleHenyeyGreenstein(ray, choice < 0.5f ? params.sigmaT.w : 0.0f, u1, u2);
    vec3 toSkyIndex = toSky.x * params.indexFromWorldX.xyz + toSky.y * params.indexFromWorldY.xyz +
                      toSky.z * params.indexFromWorldZ.xyz;
    float density = 0.5f * phaseHenyeyGreenstein(toSky, ray, params.sigmaT.w) + 0.5f * phaseIsotropic();
    float column = columnDensity(position, toSkyIndex, 3.0e38f, enough, start, samples);
    sum += params.environment.xyz * scatteredByOrders(toSky, ray, column) / density;
  }
  return sum;
}

// One ray through picture position `at` (pixels from the top left corner).
NPH_FN MarchResult marchRay(vec2 at, uint random) {
  MarchResult result;
  result.radiance = vec3(0.0f);
  result.opticalDepth = vec3(0.0f);
  result.depth = 0.0f;
  result.depthWeight = 0.0f;
  result.samples = 0.0f;
  vec3 rayLong = params.rayCorner.xyz + at.x * params.rayDx.xyz + at.y * params.rayDy.xyz;
  float stretch = length(rayLong);
  vec3 ray = rayLong / stretch;
  vec3 origin = params.originCorner.xyz + at.x * params.originDx.xyz + at.y * params.originDy.xyz;
  vec3 direction = (params.directionCorner.xyz + at.x * params.directionDx.xyz + at.y * params.directionDy.xyz) / stretch;
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, params.boxMin.xyz, params.boxMax.xyz, tNear, tFar)) return result;
  float dt = params.sigmaS.w / length(direction);
  vec3 stride = direction * dt;
  float start = params.counts.w != 0 ? nextUniform(random) : 0.5f;
  float enough = columnThatHides();
  int steps = 1;
  for (int k = 0;; k += steps) {
    float t = tNear + (float(k) + start) * dt;
    if (!(t < tFar)) break;  // also where t is NaN
    vec3 position = origin + t * direction;
    float rho = densityAndSkip(position, stride, steps);
    result.samples += 1.0f;
    if (rho <= 0.0f) continue;
    vec3 x = (rho * dt) * params.sigmaT.xyz;
    vec3 transmittance = exp(-result.opticalDepth);
    vec3 source = params.sigmaS.xyz * inScattering(position, ray, enough, random, result.samples);
    result.radiance += transmittance * source * (rho * dt) * stepIntegral(x);
    result.opticalDepth += x;
    float taken = dot(transmittance - exp(-result.opticalDepth), vec3(1.0f / 3.0f));
    result.depth += taken * (params.originCorner.w * stretch + t);
    result.depthWeight += taken;
    vec3 left = exp(-result.opticalDepth);
    if (max(left.x, max(left.y, left.z)) < params.environment.w) break;
  }
  return result;
}
