// The look-dev stage's solid things as signed distances: a round floor, two balls, a cube [BenSahla, Fournier]. Geometry alone,
// so that another renderer can stand its own light on it. Places are in stage space: world axes and units from the corner of
// the brick grid. Included at GLSL's global scope, and in C++ inside a struct, which provide
//   MarchParameters params;

NPH_CONST int kStageFloor = 0;
NPH_CONST int kStageChrome = 1;
NPH_CONST int kStageGrey = 2;
NPH_CONST int kStageCube = 3;
NPH_CONST int kStageMostSteps = 160;
NPH_CONST float kStageNowhere = 3.0e38f;
NPH_CONST float kFloorThickness = 0.01f;  // half of it, of the floor's radius
NPH_CONST float kStageTouch = 2e-5f;      // a surface is reached at such a share of the way and of the stage's size

// The stage's own length: half the cloud's.
NPH_FN float stageSize() { return params.stage.w; }

NPH_FN float floorDistance(vec3 p) {
  if (params.stageFloor.w <= 0.0f) return kStageNowhere;
  vec3 up = vec3(params.stageUp);
  vec3 from = p - vec3(params.stageFloor);
  float height = dot(from, up);
  float thick = kFloorThickness * params.stageFloor.w;
  float beside = length(from - height * up) - params.stageFloor.w;
  float above = abs(height + thick) - thick;
  float outside = length(vec3(max(beside, 0.0f), max(above, 0.0f), 0.0f));
  return min(max(beside, above), 0.0f) + outside;
}

NPH_FN float ballDistance(vec3 p, vec4 ball) {
  return ball.w > 0.0f ? length(p - vec3(ball)) - ball.w : kStageNowhere;
}

// Upright, its sides along the stage's axes; w is half an edge.
NPH_FN float cubeDistance(vec3 p, vec4 cube) {
  if (cube.w <= 0.0f) return kStageNowhere;
  vec3 from = p - vec3(cube);
  vec3 up = vec3(params.stageUp);
  vec3 across = vec3(params.stageAcross);
  vec3 q = abs(vec3(dot(from, across), dot(from, cross(up, across)), dot(from, up))) - vec3(cube.w);
  return length(max(q, vec3(0.0f))) + min(max(q.x, max(q.y, q.z)), 0.0f);
}

// Distance to the nearest thing, and which it is.
NPH_FN float stageDistance(vec3 p, NPH_OUT(int) which) {
  which = kStageFloor;
  float nearest = floorDistance(p);
  float chrome = ballDistance(p, params.stageChrome);
  float grey = ballDistance(p, params.stageGrey);
  float cube = cubeDistance(p, params.stageCube);
  if (chrome < nearest) which = kStageChrome;
  nearest = min(nearest, chrome);
  if (grey < nearest) which = kStageGrey;
  nearest = min(nearest, grey);
  if (cube < nearest) which = kStageCube;
  return min(nearest, cube);
}

// Outward unit normal at a surface, by central differences.
NPH_FN vec3 stageNormal(vec3 p) {
  int which = 0;
  float h = 2e-3f * stageSize();
  vec3 x = vec3(h, 0.0f, 0.0f);
  vec3 y = vec3(0.0f, h, 0.0f);
  vec3 z = vec3(0.0f, 0.0f, h);
  return normalize(vec3(stageDistance(p + x, which) - stageDistance(p - x, which),
                        stageDistance(p + y, which) - stageDistance(p - y, which),
                        stageDistance(p + z, which) - stageDistance(p - z, which)));
}

// Where a ray enters and leaves the ball that holds the whole stage; y ≤ x where it does not.
NPH_FN vec2 stageBounds(vec3 origin, vec3 ray) {
  vec3 from = origin - vec3(params.stageFloor);
  float middle = -dot(from, ray);
  vec3 aside = from + middle * ray;
  float inside = params.stage.x * params.stage.x - dot(aside, aside);
  if (inside <= 0.0f) return vec2(0.0f);
  float extent = sqrt(inside);
  return vec2(max(middle - extent, 0.0f), middle + extent);
}

// Way along `ray` (unit) to the first surface within `reach`, by sphere tracing; below 0 where there is none.
NPH_FN float stageHit(vec3 origin, vec3 ray, float reach, NPH_OUT(int) which) {
  which = kStageFloor;
  vec2 bounds = stageBounds(origin, ray);
  float end = min(bounds.y, reach);
  float t = bounds.x;
  float found = -1.0f;
  for (int i = 0; i < kStageMostSteps && t < end && found < 0.0f; ++i) {
    float d = stageDistance(origin + t * ray, which);
    t += d;
    if (d < kStageTouch * (t + stageSize())) found = t;
  }
  return found;
}

// How much of a light the things let through to `p`: min(k · distance/t) along the way [Quilez]; 0 or 1 where shadows are hard.
NPH_FN float stageShadow(vec3 p, vec3 toLight, float reach) {
  int which = 0;
  float sharpness = params.stage.y;
  float end = min(stageBounds(p, toLight).y, reach);
  float light = 1.0f;
  float least = 5e-3f * stageSize();
  float t = least;
  for (int i = 0; i < kStageMostSteps && t < end && light > 0.0f; ++i) {
    float d = stageDistance(p + t * toLight, which);
    if (sharpness > 0.0f) light = min(light, max(sharpness * d / t, 0.0f));
    if (d < kStageTouch * (t + stageSize())) light = 0.0f;
    t += max(d, least);
  }
  return light;
}
