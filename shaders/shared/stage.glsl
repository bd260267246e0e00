// Light on the look-dev stage and the medium before it [MODEL.md, section 2]: surface · T + scattered, mirrors in which the
// medium appears, the medium's shadow on every surface. Included as march.glsl is, after it and stage_shapes.glsl.

NPH_CONST int kMostMirrors = 2;         // one after another
NPH_CONST float kMirrorReflects = 0.9f;
NPH_CONST float kHidden = 1e3f;         // optical depth behind a surface

struct StageSurface {
  vec3 diffuse;     // albedo
  float specular;   // K_s
  float shininess;  // s of Blinn–Phong
  float mirror;     // share that is reflected
};

// `wide`: what a pixel covers there, world units.
NPH_FN StageSurface stageSurface(vec3 p, int which, float wide) {
  StageSurface s;
  s.diffuse = vec3(0.18f);  // photographers' grey
  s.specular = 0.25f;
  s.shininess = 40.0f;
  s.mirror = 0.0f;
  if (which == kStageFloor) {
    vec3 up = vec3(params.stageUp);
    vec3 from = p - vec3(params.stageFloor);
    float edge = params.stageUp.w;
    float squares = floor(dot(from, vec3(params.stageAcross)) / edge) +
                    floor(dot(from, cross(up, vec3(params.stageAcross))) / edge);
    bool odd = squares - 2.0f * floor(0.5f * squares) > 0.5f;
    // Squares that a pixel cannot resolve turn into their mean.
    float contrast = clamp(2.0f - 2.0f * wide / edge, 0.0f, 1.0f);
    s.diffuse = vec3(0.3f + (odd ? 0.2f : -0.2f) * contrast);
    s.specular = 0.04f;
  } else if (which != kStageGrey) {
    s.diffuse = vec3(0.0f);
    s.specular = 1.0f;
    s.shininess = 300.0f;
    s.mirror = kMirrorReflects;
  }
  if (params.stage.z <= 0.0f) s.specular = 0.0f;
  return s;
}

// Mean over the half-space about `normal`, weighted by the cosine, of the environment's radiance: from so many directions, evenly
// over the sphere (a Fibonacci spiral), exact where the environment is uniform.
NPH_CONST int kAmbientDirections = 24;
NPH_FN vec3 ambientRadiance(vec3 normal) {
  vec3 sum = vec3(0.0f);
  float weights = 0.0f;
  for (int i = 0; i < kAmbientDirections; ++i) {
    float z = 1.0f - (2.0f * float(i) + 1.0f) / float(kAmbientDirections);
    float r = sqrt(max(0.0f, 1.0f - z * z));
    float angle = 2.39996323f * float(i);  // π (3 − √5)
    vec3 direction = vec3(r * cos(angle), r * sin(angle), z);
    float weight = max(0.0f, dot(normal, direction));
    sum += weight * environmentRadiance(direction);
    weights += weight;
  }
  return sum / weights;
}

// Radiance that a surface sends back along `ray`, without what it mirrors: I_p is irradiance/π, so that `diffuse` is an albedo;
// each light through the things' shadows and the medium; the environment as ambient light, which nothing shades.
NPH_FN vec3 stageShade(StageSurface s, vec3 p, vec3 position, vec3 normal, vec3 ray, float enough, float start,
                       NPH_INOUT(vec4) cost) {
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < params.counts.x; ++i) {
    Lighting l = lightingFrom(i, position);
    float facing = dot(normal, l.toLight);
    float through = facing > 0.0f ? stageShadow(p, l.toLight, l.reach) : 0.0f;
    float reach = through > 0.0f ? l.reach : 0.0f;
    float column = columnTowards(position, 0.0f, l.toLightIndex, reach, enough, start, cost);
    vec3 halfway = normalize(l.toLight - ray);
    float highlight = s.specular * pow(max(dot(normal, halfway), 1e-6f), s.shininess);
    sum += (through / kPi) * l.irradiance * lessened(column * vec3(params.sigmaT)) *
           (s.diffuse * max(facing, 0.0f) + vec3(highlight));
  }
  if (skyKind() != kSkyNone) sum += s.diffuse * ambientRadiance(normal);
  return sum;
}

NPH_FN vec3 stageFromIndex(vec3 v) {
  return v.x * vec3(params.worldFromIndexX) + v.y * vec3(params.worldFromIndexY) + v.z * vec3(params.worldFromIndexZ);
}
NPH_FN vec3 indexFromStage(vec3 v) {
  return v.x * vec3(params.indexFromWorldX) + v.y * vec3(params.indexFromWorldY) + v.z * vec3(params.indexFromWorldZ);
}

// As marchAlong, with the stage: what lies behind a surface is hidden, and the surface counts as seen.
NPH_FN MarchResult stageAlong(Ray r, float start, uint random, uint number) {
  MarchResult result = nothingMarched();
  vec3 left = vec3(1.0f);
  float enough = columnThatHides(params.environment.w, params.counts.y);
  float back = r.before;  // way from the origin back to where the ray begins
  float gone = 0.0f;      // way to there from the camera
  float pixel = length(vec3(params.rayDy));
  bool done = false;
  for (int mirrors = 0; mirrors <= kMostMirrors && !done; ++mirrors) {
    int which = 0;
    vec3 origin = stageFromIndex(r.origin) - back * r.ray;
    float hit = stageHit(origin, r.ray, kStageNowhere, which);
    r.reach = hit < 0.0f ? kStageNowhere : hit - back;
    MarchResult m = marchAlong(r, start, hashBits(random + uint(mirrors)), number);
    result.radiance += left * m.radiance;
    result.cost += vec4(m.cost.x, 0.0f, m.cost.z, m.cost.w);
    result.cost.y = max(result.cost.y, m.cost.y);
    left *= lessened(m.opticalDepth);
    if (mirrors == 0) {
      float seen = hit < 0.0f ? 0.0f : dot(left, vec3(1.0f / 3.0f));
      result.opticalDepth = hit < 0.0f ? m.opticalDepth : vec3(kHidden);
      result.depth = m.depth + seen * hit;
      result.depthWeight = m.depthWeight + seen;
    } else if (hit < 0.0f && skyKind() != kSkyNone) {
      result.radiance += left * environmentRadiance(r.ray);
    }
    done = hit < 0.0f;
    if (!done) {
      vec3 p = origin + hit * r.ray;
      vec3 normal = stageNormal(p);
      gone += hit;
      float wide = gone * pixel / max(abs(dot(normal, r.ray)), 0.05f);
      StageSurface s = stageSurface(p, which, wide);
      p += (1e-3f * stageSize()) * normal;
      vec3 position = indexFromStage(p);
      result.radiance += left * stageShade(s, p, position, normal, r.ray, enough, start, result.cost);
      left *= s.mirror;
      done = s.mirror <= 0.0f;
      r.ray = r.ray - (2.0f * dot(r.ray, normal)) * normal;
      r.origin = position;
      r.direction = indexFromStage(r.ray);
      r.before = gone;
      back = 0.0f;
    }
  }
  return result;
}
