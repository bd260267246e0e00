// The march: view transmittance and in-scattered radiance along one ray, by steps that follow the optical depth, over a grid
// of bricks [MODEL.md, section 2]. Included at GLSL's global scope, and in C++ inside a struct, after walk.glsl and light.glsl.

// Consecutive steps are lit together, at the place of one of them, until they take this share of the view or are this many:
// light that is marched for is by far the dearest, and what the cache knows is cheap. The place is drawn by what each step
// scatters, so that the mean over samples is as if each step had been lit. Fixed steps are lit one by one.
NPH_CONST float kLitTogetherShare = 0.05f;
NPH_CONST float kCachedTogetherShare = 0.02f;
NPH_CONST int kLitTogetherSteps = 8;
// The longest step, in the setting's for what voxels are taken to cover: a brick where that is a voxel.
NPH_CONST float kLongestStep = 8.0f;

struct MarchResult {
  vec3 radiance;       // scattered towards the camera
  vec3 opticalDepth;   // of the whole ray, or up to where it was given up, per channel
  float depth;         // world distance from the camera, weighted by what each step takes from the view; 0 without medium
  float depthWeight;   // that weight's sum: 1 − transmittance, mean over channels
  vec4 cost;           // x: densities read: view, shadow and sky. y: 1 where a driver ended a loop before its time. z, w: see
                       // checkSkipped
};

// Length of a step inside a brick, world units; `fine` is that of the setting, `coarse` the same where voxels count that cover
// less than a pixel as many. Longer than fine, and than coarse, where what the step may take of the view stays small, and longer
// than coarse where small too is what it may vary by: `left` of the view is there to be taken. Fixed steps are coarse.
NPH_FN float stepIn(uvec2 word, float fine, float coarse, float left) {
  if (params.walk.z <= 0.0f) return coarse;
  // Of the view a world unit, at most.
  float taken = left * max(params.sigmaT.x, max(params.sigmaT.y, params.sigmaT.z)) * wordMaximum(word);
  float small = params.walk.z / max(taken, 1e-30f);
  float even = params.walk.w / max(taken * (1.0f - wordMinimumShare(word)), 1e-30f);
  return clamp(min(small, even), clamp(small, fine, coarse), kLongestStep * coarse);
}

// Where in each step a ray reads, for sample `number` of the pixel whose tile value is `jitter`: the additive recurrence by
// the golden ratio, in integers, so that a pixel's samples cover the step evenly whatever their number.
NPH_FN float stepStart(float jitter, uint number) {
  if (params.counts.w == 0) return 0.5f;
  return float((uint(jitter * 16777216.0f) * 256u + number * 2654435769u) >> 8u) * (1.0f / 16777216.0f);
}

// The number that draws which of the steps lit together light is asked at: another such recurrence, by √2. As bits,
// stepStart's is taken back from it.
NPH_FN float litStart(float start, uint lit, uint number) {
  uint bits = uint(start * 16777216.0f) * 256u + number * (1779033704u - 2654435769u) + lit * 2447445414u;
  return float(bits >> 8u) * (1.0f / 16777216.0f);
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
  r.reach = kSunReach;
  return r;
}

// The way of a ray through one brick, in equal steps.
struct Stretch {
  uvec2 word;  // of the brick
  vec3 corner;
  float size;  // of its voxels, in those of the index
  float end;   // where the ray leaves it, or the medium
  float dt;
};

NPH_FN Stretch noStretch(float t) {
  Stretch s;
  s.word = uvec2(0u);
  s.corner = vec3(0.0f);
  s.size = 1.0f;
  s.end = t;
  s.dt = 1.0f;
  return s;
}

// The stretch from `t` on; `left` of the view is there to be taken. Distances are in world units from the ray's origin.
NPH_FN Stretch stretchFrom(float t, float tFar, Ray r, Course course, float left, NPH_INOUT(vec4) cost) {
  Stretch s;
  float voxel = 1.0f / length(r.direction);  // world units
  float margin = params.walk.x * voxel;
  // The brick is the one that the ray is in a hair further on, so that rounding never holds it on a face.
  vec3 position = r.origin + (t + margin) * r.direction;
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  s.word = isOutside(brick) ? uvec2(0u) : brickWord(brick);
  int edge = wordEdge(s.word);
  s.corner = cubeCorner(brick, edge);
  s.size = float(edge);
  float way = wayOut(position, course, s.corner, kBrickEdge * s.size);
  s.end = min(tFar, t + margin + max(0.0f, way));
  float fine = params.sigmaS.w * s.size * voxel;
  float coarse = params.sigmaS.w * max(params.shadow.z, s.size) * voxel;
  s.dt = (s.end - t) / max(ceil((s.end - t) / stepIn(s.word, fine, coarse, left)), 1.0f);
  if (wordIsEmpty(s.word))
    checkSkipped(r.origin, r.direction, t + 2.0f * margin, min(s.end, t + max(0.0f, way)) - margin, params.sigmaS.w * voxel, cost);
  return s;
}

// Steps that are lit together.
struct LitGroup {
  int steps;
  float taken;  // of the view, mean over channels
  vec3 share;   // ∫ e^(−τ) ρ ds
  float mean;   // of it, over channels
  float place;  // where light is asked, world distance along the ray
  float rho;    // the density there
  float draw;   // in [0, 1): what is left of the number that draws it
};

NPH_FN LitGroup noneLit(float draw) {
  LitGroup g;
  g.steps = 0;
  g.taken = 0.0f;
  g.share = vec3(0.0f);
  g.mean = 0.0f;
  g.place = 0.0f;
  g.rho = 0.0f;
  g.draw = draw;
  return g;
}

NPH_FN bool isFull(LitGroup g) {
  return g.steps >= (params.walk.z > 0.0f ? kLitTogetherSteps : 1) || g.taken >= (NPH_CACHED ? kCachedTogetherShare : kLitTogetherShare);
}

// A step at `place` that scatters `share` joins: it is the one drawn with the chance of its part of the whole, and one number
// serves all draws, since it stays uniform within either outcome. Without random starts the place is the centre of weight.
NPH_FN void join(NPH_INOUT(LitGroup) g, vec3 share, float place, float rho, float taken) {
  float mean = dot(share, vec3(1.0f / 3.0f));
  g.steps += 1;
  g.taken += taken;
  g.share += share;
  g.mean += mean;
  float chance = mean / max(g.mean, 1e-30f);
  bool drawn = g.draw < chance;
  g.draw = (drawn ? g.draw : g.draw - chance) / max(drawn ? chance : 1.0f - chance, 1e-30f);
  float moved = params.counts.w == 0 ? chance : drawn ? 1.0f : 0.0f;
  g.place += moved * (place - g.place);
  g.rho += moved * (rho - g.rho);
}

// Marches along a ray; each step is read at the share `start` of its length; `random` is the pixel's own state, `number` the
// sample's.
NPH_FN MarchResult marchAlong(Ray r, float start, uint random, uint number) {
  MarchResult result = nothingMarched();
  float t = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(r.origin, r.direction, vec3(params.boxMin), vec3(params.boxMax), t, tFar)) return result;
  tFar = min(tFar, r.reach);
  float enough = columnThatHides(params.environment.w, params.counts.y);
  Course course = courseOf(r.direction);
  vec3 before = vec3(1.0f);  // transmittance up to t
  Stretch s = noStretch(t);
  uint lit = 0u;
  bool last = !(t < tFar);
  // Loops, not branches: some drivers run the whole body of a branch that no pixel of a group takes.
  while (!last) {
    LitGroup group = noneLit(litStart(start, lit, number));
    while (!last && !isFull(group)) {
      while (!(t < s.end) && t < tFar) {
        s = stretchFrom(t, tFar, r, course, max(before.x, max(before.y, before.z)), result.cost);
        if (wordIsEmpty(s.word)) t = s.end;
      }
      while (t < s.end && !last && !isFull(group)) {
        float middle = t + start * s.dt;
        vec3 position = r.origin + middle * r.direction;
        float rho = brickDensity(s.word, (position - s.corner) / s.size);
        result.cost.x += 1.0f;
        checkBound(s.word, rho, result.cost);
        vec3 x = (rho * s.dt) * vec3(params.sigmaT);
        result.opticalDepth += x;
        vec3 left = lessened(result.opticalDepth);
        vec3 weight = stepWeight(rho * s.dt, x, before, left);
        if (NPH_EMISSION) result.radiance += emissionAt(position) * weight;
        float taken = dot(before - left, vec3(1.0f / 3.0f));
        join(group, powderAt(position, rho) * weight, middle, rho, taken);
        result.depth += taken * (r.before + middle);
        before = left;
        last = max(left.x, max(left.y, left.z)) < params.environment.w;
        t += s.dt;
        // A rest below half a step is rounding.
        if (s.end - t < 0.5f * s.dt) t = s.end;
      }
      last = last || !(t < tFar);  // also where t is NaN
    }
    result.depthWeight += group.taken;
    if (group.mean > 0.0f) {
      vec3 position = r.origin + group.place * r.direction;
      vec3 light = vec3(params.sigmaS) * inScattering(position, group.rho, r.ray, enough, number, lit, random, result.cost);
      lit += 1u;
      result.radiance += light * group.share;
    }
  }
  // Not by `last`, which a compiler may take to be true behind the loop.
  bool ended = !(t < tFar) || max(before.x, max(before.y, before.z)) < params.environment.w;
  result.cost.y = max(result.cost.y, ended ? 0.0f : 1.0f);
  return result;
}

// One ray through a picture position.
NPH_FN MarchResult marchRay(vec2 at, float start, uint random, uint number) {
  return marchAlong(rayThrough(at), start, random, number);
}
