// The march: view transmittance and in-scattered radiance along one ray, by fixed steps over a grid of bricks
// [MODEL.md, section 2]. Included at GLSL's global scope, and in C++ inside a struct, after walk.glsl and light.glsl.

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
        vec3 scattering = powderAt(origin + middle * direction, rho) * weight;
        share += scattering;
        place += dot(scattering, vec3(1.0f / 3.0f)) * middle;
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
