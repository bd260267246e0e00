// The march: view transmittance and in-scattered radiance along one ray, by steps that follow the optical depth, over a grid
// of bricks [MODEL.md, section 2]. Included at GLSL's global scope, and in C++ inside a struct, after walk.glsl and light.glsl.

// Neighbouring steps of a brick are lit together, from their centre of weight, until they take this share of the view or are
// this many: light is by far the dearest, and within them it changes by little. Both vanish as steps do.
NPH_CONST float kLitTogetherShare = 0.05f;
NPH_CONST int kLitTogetherSteps = 4;
// The longest step, in the shortest: a brick where that is a voxel.
NPH_CONST float kLongestStep = 8.0f;

struct MarchResult {
  vec3 radiance;       // scattered towards the camera
  vec3 opticalDepth;   // of the whole ray, or up to where it was given up, per channel
  float depth;         // world distance from the camera, weighted by what each step takes from the view; 0 without medium
  float depthWeight;   // that weight's sum: 1 − transmittance, mean over channels
  vec4 cost;           // x: densities read: view, shadow and sky. y: 1 where a driver ended a loop before its time. z, w: see
                       // checkSkipped
};

// Length of a step inside a brick, world units; `shortest` is that of the setting. Longer where what the step may take of the
// view stays small, and small too what it may vary by: `left` of the view is there to be taken.
NPH_FN float stepIn(uvec2 word, float shortest, float left) {
  if (params.walk.z <= 0.0f) return shortest;
  // Of the view a world unit, at most.
  float taken = left * max(params.sigmaT.x, max(params.sigmaT.y, params.sigmaT.z)) * wordMaximum(word);
  float small = params.walk.z / max(taken, 1e-30f);
  float even = params.walk.w / max(taken * (1.0f - wordMinimumShare(word)), 1e-30f);
  return clamp(min(small, even), shortest, kLongestStep * shortest);
}

// Where in each step a ray reads, for sample `number` of the pixel whose tile value is `jitter`: the additive recurrence by
// the golden ratio, in integers, so that a pixel's samples cover the step evenly whatever their number.
NPH_FN float stepStart(float jitter, uint number) {
  if (params.counts.w == 0) return 0.5f;
  return float((uint(jitter * 16777216.0f) * 256u + number * 2654435769u) >> 8u) * (1.0f / 16777216.0f);
}

NPH_FN MarchResult nothingMarched() {
  MarchResult result;
  result.radiance = vec3(0.0f);
  result.opticalDepth = vec3(0.0f);
  result.depth = 0.0f;
  result.depthWeight = 0.0f;
  result.cost = vec4(0.0f);
  return result;
}

// A ray in the shape that walks take.
struct Ray {
  vec3 origin;     // index space
  vec3 direction;  // voxels per world unit along the ray
  vec3 ray;        // the same, unit and in world axes
  float before;    // world distance from the camera to `origin`
  float reach;     // world distance from `origin` beyond which nothing is seen
};

// The ray through picture position `at`, pixels from the top left corner.
NPH_FN Ray rayThrough(vec2 at) {
  Ray r;
  vec3 rayLong = vec3(params.rayCorner) + at.x * vec3(params.rayDx) + at.y * vec3(params.rayDy);
  float stretch = length(rayLong);
  r.ray = rayLong / stretch;
  r.origin = vec3(params.originCorner) + at.x * vec3(params.originDx) + at.y * vec3(params.originDy);
  r.direction = (vec3(params.directionCorner) + at.x * vec3(params.directionDx) + at.y * vec3(params.directionDy)) / stretch;
  r.before = params.originCorner.w * stretch;
  r.reach = 3.0e38f;
  return r;
}

// Marches along a ray; each step is read at the share `start` of its length; `random` is the pixel's own, `number` the
// sample's.
NPH_FN MarchResult marchAlong(Ray r, float start, uint random, uint number) {
  MarchResult result = nothingMarched();
  vec3 origin = r.origin;
  vec3 direction = r.direction;
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return result;
  tFar = min(tFar, r.reach);
  float voxel = 1.0f / length(direction);  // world units
  float margin = params.walk.x * voxel;
  float enough = columnThatHides(params.environment.w, params.counts.y);
  Course course = courseOf(direction);
  uint lit = 0u;
  uvec2 word = uvec2(0u);  // of the brick that the ray is in
  vec3 corner = vec3(0.0f);
  float size = 1.0f;   // of its voxels, in those of the index
  float tEnd = tNear;  // where the ray leaves it
  float dt = voxel;
  float t = tNear;
  vec3 before = vec3(1.0f);  // transmittance up to t
  bool last = !(t < tFar);
  float arrived = last ? 1.0f : 0.0f;  // 1 once `last` was seen; see columnDensity
  // Loops, not branches: some drivers run the whole body of a branch that no pixel of a group takes.
  while (!last) {
    while (!(t < tEnd) && t < tFar) {
      // A brick is the one that the ray is in a hair further on, so that rounding never holds it on a face.
      vec3 position = origin + (t + margin) * direction;
      ivec3 brick = ivec3(floor(position / kBrickEdge));
      word = isOutside(brick) ? uvec2(0u) : brickWord(brick);
      int edge = wordEdge(word);
      corner = cubeCorner(brick, edge);
      size = float(edge);
      float way = wayOut(position, course, corner, kBrickEdge * size);
      tEnd = min(tFar, t + margin + max(0.0f, way));
      float steps = ceil((tEnd - t) / stepIn(word, params.sigmaS.w * max(params.shadow.z, size) * voxel, max(before.x, max(before.y, before.z))));
      dt = (tEnd - t) / max(steps, 1.0f);
      if (wordIsEmpty(word)) {
        checkSkipped(origin, direction, t + 2.0f * margin, min(tEnd, t + max(0.0f, way)) - margin, params.sigmaS.w * voxel, result.cost);
        t = tEnd;
      }
    }
    vec3 share = vec3(0.0f);  // of the view, in these steps: ∫ e^(−τ) ρ ds
    float place = 0.0f;       // its mean distance along the ray, times its mean over channels
    float taken = 0.0f;
    for (int k = 0; k < kLitTogetherSteps && t < tEnd && taken < kLitTogetherShare && !last; ++k) {
      float middle = t + start * dt;
      float rho = brickDensity(word, (origin + middle * direction - corner) / size);
      result.cost.x += 1.0f;
      checkBound(word, rho, result.cost);
      vec3 x = (rho * dt) * vec3(params.sigmaT);
      result.opticalDepth += x;
      vec3 left = lessened(result.opticalDepth);
      vec3 weight = stepWeight(rho * dt, x, before, left);
      vec3 scattering = powderAt(origin + middle * direction, rho) * weight;
      if (NPH_EMISSION) result.radiance += emissionAt(origin + middle * direction) * weight;
      share += scattering;
      place += dot(scattering, vec3(1.0f / 3.0f)) * middle;
      float step = dot(before - left, vec3(1.0f / 3.0f));
      result.depth += step * (r.before + middle);
      taken += step;
      before = left;
      last = max(left.x, max(left.y, left.z)) < params.environment.w;
      t += dt;
      // A rest below half a step is rounding: steps divide the way through a brick evenly.
      if (tEnd - t < 0.5f * dt) t = tEnd;
    }
    result.depthWeight += taken;
    last = last || !(t < tFar);  // also where t is NaN
    float mean = dot(share, vec3(1.0f / 3.0f));
    if (mean > 0.0f) {
      // Each place has numbers of its own, so that more or fewer drawn at another do not change them.
      uint placeRandom = hashBits(random ^ lit);
      vec3 position = origin + (place / mean) * direction;
      vec3 light = vec3(params.sigmaS) * inScattering(position, r.ray, enough, lit, number, placeRandom, result.cost);
      lit += 1u;
      result.radiance += light * share;
    }
    arrived = last ? 1.0f : 0.0f;
  }
  result.cost.y = max(result.cost.y, 1.0f - arrived);
  return result;
}

// One ray through a picture position.
NPH_FN MarchResult marchRay(vec2 at, float start, uint random, uint number) {
  return marchAlong(rayThrough(at), start, random, number);
}
