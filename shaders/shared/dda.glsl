// The exact voxel walk: density is that of the nearest sample, constant over the cell i ± ½ of each, and a ray is cut where it
// passes from cell to cell [Amanatides and Woo 1987]. Bricks are of the finest level. Included as march.glsl is, after it; the scope provides as well
//   float brickSample(uvec2 word, ivec3 sample);   one of a brick's samples, each in [0, 8)

// As marchAlong; each cell is lit at the middle of the way through it.
NPH_FN MarchResult walkVoxels(Ray r, uint random, uint number) {
  MarchResult result = nothingMarched();
  // Here cell i is [i, i + 1), and the medium ends half a voxel beyond its samples.
  vec3 origin = r.origin + vec3(0.5f);
  vec3 direction = r.direction;
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin) + vec3(1.0f), vec3(params.boxMax), tNear, tFar)) return result;
  tFar = min(tFar, r.reach);
  float margin = params.walk.x / length(direction);
  float enough = columnThatHides(params.environment.w, params.counts.y);
  Course course = courseOf(direction);
  vec3 before = vec3(1.0f);
  uint lit = 0u;
  float t = tNear;
  bool last = !(t < tFar);
  float arrived = last ? 1.0f : 0.0f;  // 1 once `last` was seen; see columnDensity
  while (!last) {
    // The voxel is the one that the ray is in a hair further on, so that rounding never holds it on a face.
    vec3 position = origin + (t + margin) * direction;
    ivec3 brick = ivec3(floor(position / kBrickEdge));
    uvec2 word = isOutside(brick) ? uvec2(0u) : brickWord(brick);
    int edge = wordEdge(word);
    vec3 corner = cubeCorner(brick, edge);
    bool empty = wordIsEmpty(word);
    float size = empty ? kBrickEdge * float(edge) : float(edge);
    vec3 local = floor((position - corner) / float(edge));
    vec3 cellCorner = empty ? corner : corner + local * float(edge);
    float tEnd = min(tFar, t + margin + max(0.0f, wayOut(position, course, cellCorner, size)));
    float ds = tEnd - t;
    float rho = empty ? 0.0f : brickSample(word, clamp(ivec3(local), ivec3(0), ivec3(7)));
    result.cost.x += empty ? 0.0f : 1.0f;
    vec3 x = (rho * ds) * vec3(params.sigmaT);
    result.opticalDepth += x;
    vec3 left = lessened(result.opticalDepth);
    float taken = dot(before - left, vec3(1.0f / 3.0f));
    float middle = t + 0.5f * ds;
    result.depth += taken * (r.before + middle);
    result.depthWeight += taken;
    if (rho > 0.0f) {
      vec3 at = r.origin + middle * direction;
      vec3 share = powderAt(at, rho) * before * (rho * ds) * stepIntegral(x);
      vec3 light = vec3(params.sigmaS) * inScattering(at, rho, r.ray, enough, number, lit, random, result.cost);
      result.radiance += light * share;
      lit += 1u;
    }
    before = left;
    t = tEnd;
    last = !(t < tFar) || max(left.x, max(left.y, left.z)) < params.environment.w;  // also where t is NaN
    arrived = last ? 1.0f : 0.0f;
  }
  result.cost.y = max(result.cost.y, 1.0f - arrived);
  return result;
}
