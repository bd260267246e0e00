// Light asked of a coarse volume instead of being marched for: columns of density towards each light, and what the sky
// scatters. Its samples lie on a lattice in blocks of 16³ voxels, kept where a block holds density. Included as walk.glsl is,
// after it; GLSL's scope or the struct provides
//   uint blockWord(ivec3 block);               0: not kept. Else 1 + its place in the cache: 10 bits an axis
//   float cachedColumn(vec3 texel);            trilinear; whole numbers are samples; 1/(1 + params.cache.y · column)
//   vec4 cachedSky(int part, vec3 texel);      the same; 0: light scattered alike to all sides, see skyKept. 1: its slope. 2: openness

NPH_CONST float kBlockEdge = 16.0f;

// Texel of a position in a cache with `samples` along a block's edge; x is below 0 where the block is not kept.
NPH_FN vec3 cacheTexel(vec3 position, int samples) {
  ivec3 block = ivec3(floor(position / kBlockEdge));
  if (block.x < 0 || block.y < 0 || block.z < 0 || block.x >= params.blockCount.x || block.y >= params.blockCount.y ||
      block.z >= params.blockCount.z)
    return vec3(-1.0f);
  uint word = blockWord(block);
  if (word == 0u) return vec3(-1.0f);
  uint place = word - 1u;
  ivec3 corner = samples * ivec3(int(place & 1023u), int((place >> 10u) & 1023u), int(place >> 20u));
  return vec3(corner) + (position - vec3(block) * kBlockEdge) * (float(samples - 1) / kBlockEdge);
}

// ∫ ρ ds from `position`, in a block that is kept, to light `light`, world units: the first voxels read, where the cloud shades
// itself most finely, the rest from the cache. `reach` as columnDensity's; `start` is the share of a step at which it is read.
NPH_FN float lightColumn(int light, vec3 position, vec3 direction, float reach, float start, NPH_INOUT(vec4) cost) {
  float way = 0.0f;
  vec3 texel = cacheTexel(position, params.cacheShape.x);
  if (NPH_NEAR) {
    float wanted = min(params.cache.z * voxelAt(position, params.shadow.w) / length(direction), reach);
    vec3 there = cacheTexel(position + wanted * direction, params.cacheShape.x);
    if (there.x >= 0.0f) {
      way = wanted;
      texel = there;
    }
  }
  texel.z += float(light * params.cacheShape.z);
  // Below the least half, or byte, nothing is seen.
  float column = (1.0f / max(cachedColumn(max(texel, vec3(0.0f))), 6e-8f) - 1.0f) / params.cache.y;
  if (NPH_NEAR) {
    // The steps' ends lie at the squares of even shares of the way.
    Course course = courseOf(direction);
    float share = 1.0f / max(params.cache.w, 1.0f);
    for (int i = 0; i < int(params.cache.w); ++i) {
      float from = float(i * i) * share * share * way;
      float ds = float(2 * i + 1) * share * share * way;
      float toExit = 0.0f;
      column += ds * densityAndExit(position + (from + start * ds) * direction, course, toExit);
      cost.x += 1.0f;
    }
  }
  return column;
}

// Between samples light falls as e^(−depth): mixed as it is, places just inside a cloud would come out too bright. So the sky
// is kept, as columns are, by the depth that would leave `share` of an open one; both parts lie between 0 and 1.
NPH_CONST float kSkyMixedBy = 0.3f;
NPH_CONST float kLeastSkyShare = 1e-9f;
NPH_FN vec3 skyKept(vec3 share) {
  return vec3(1.0f) / (vec3(1.0f) - kSkyMixedBy * log(clamp(share, vec3(kLeastSkyShare), vec3(1.0f))));
}
NPH_FN vec3 shareFromKept(vec3 kept) {
  return exp((vec3(1.0f) - vec3(1.0f) / max(kept, vec3(0.1f))) * (1.0f / kSkyMixedBy));
}
// Each coordinate is at most 3, where all light comes from one side and goes on.
NPH_FN vec3 slopeKept(vec3 slope) { return slope * (1.0f / 6.0f) + vec3(0.5f); }
NPH_FN vec3 slopeFromKept(vec3 kept) { return (kept - vec3(0.5f)) * 6.0f; }

// What the sky scatters towards `ray`, per unit density and before σ_s. The two bands that are kept may fall below 0 where
// light comes from one side alone.
NPH_FN vec3 skyScattering(vec3 position, vec3 ray) {
  vec3 texel = max(cacheTexel(position, params.cacheShape.y), vec3(0.0f));
  return vec3(params.skyOpen) * shareFromKept(vec3(cachedSky(0, texel))) * max(0.0f, 1.0f + dot(slopeFromKept(vec3(cachedSky(1, texel))), ray));
}

// Share of light that leaves the medium unscattered where it sets out evenly to all sides.
NPH_FN vec3 opennessAt(vec3 position) {
  vec3 texel = max(cacheTexel(position, params.cacheShape.y), vec3(0.0f));
  return shareFromKept(vec3(cachedSky(2, texel)));
}
