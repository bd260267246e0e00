// What the samples of the light cache hold. Included as walk.glsl is, after light.glsl.

NPH_CONST int kSkyDirections = 6;

// Index-space position of sample `local` of a block.
NPH_FN vec3 cachePosition(ivec3 block, ivec3 local, int samples) {
  return vec3(block) * kBlockEdge + vec3(local) * (kBlockEdge / float(samples - 1));
}

// Steps that fill the cache from a position, voxels of the index and growth, from those of a brick that is not coarser than the
// cache takes voxels to be.
NPH_FN vec2 stepsFrom(vec3 position, vec2 steps) {
  return vec2(steps.x * voxelAt(position, params.shadow.w) / params.shadow.w, steps.y);
}

// The whole column from a position to a light, as the cache keeps it.
NPH_FN float columnToCache(int light, vec3 position, NPH_INOUT(vec4) cost) {
  Lighting l = lightingFrom(light, position);
  // Far octaves see through columns that hide the first order altogether: none is given up on.
  float column = columnDensity(position, l.toLightIndex, l.reach, 1e30f, stepsFrom(position, vec2(params.cacheSteps)), 0.5f, cost);
  return 1.0f / (1.0f + params.cache.y * column);
}

// Neighbouring samples look in different directions, so that what is mixed of eight of them knows of eight times as many: how
// far sample `local` of a block turns the spiral, x: along its axis, in shares of a direction. y: about it.
NPH_FN vec2 skyTurn(ivec3 block, ivec3 local, int samples) {
  ivec3 place = block * (samples - 1) + local;
  int odd = (place.x & 1) + 2 * (place.y & 1) + 4 * (place.z & 1);
  float around = 0.6180339888f * float(odd);
  return vec2((float(odd) + 0.5f) / 8.0f, 6.28318531f * (around - floor(around)));
}

// Directions evenly over the sphere: a Fibonacci spiral, turned.
NPH_FN vec3 skyDirection(int i, vec2 turn) {
  float z = 1.0f - 2.0f * (float(i) + turn.x) / float(kSkyDirections);
  float r = sqrt(max(0.0f, 1.0f - z * z));
  float angle = 2.39996323f * float(i) + turn.y;  // π (3 − √5)
  return vec3(r * cos(angle), r * sin(angle), z);
}

// What the sky scatters at a position towards a ray, per unit density and before σ_s, to first order in the ray's direction
// (the phase function's and the sky's first two bands of spherical harmonics), as the cache keeps it: see skyScattering. And
// how open the place is.
NPH_FN void skyToCache(vec3 position, vec2 turn, NPH_OUT(vec4) sky0, NPH_OUT(vec4) sky1, NPH_OUT(vec4) open, NPH_INOUT(vec4) cost) {
  // Of a sky that comes from all sides, less than 1e-3 is not seen; without one there are no orders.
  float enough = columnThatHides(1e-3f, skyKind() == kSkyNone ? 0 : params.counts.y);
  vec2 steps = stepsFrom(position, vec2(params.cacheSteps.z, params.cacheSteps.w));
  vec3 toSkies[kSkyDirections];
  float columns[kSkyDirections];
  vec3 openness = vec3(0.0f);
  for (int i = 0; i < kSkyDirections; ++i) {
    vec3 toSky = skyDirection(i, turn);
    toSkies[i] = toSky;
    vec3 toSkyIndex = toSky.x * vec3(params.indexFromWorldX) + toSky.y * vec3(params.indexFromWorldY) +
                      toSky.z * vec3(params.indexFromWorldZ);
    columns[i] = columnDensity(position, toSkyIndex, kSunReach, enough, steps, 0.5f, cost);
    openness += lessened(columns[i] * vec3(params.sigmaT)) * (1.0f / float(kSkyDirections));
  }
  vec3 again = NPH_OPEN ? scatteredAgain(openness) : vec3(params.octaves.y);
  vec3 even = vec3(0.0f);
  vec3 unhidden = vec3(0.0f);  // the same where nothing hides the sky
  vec3 slope = vec3(0.0f);
  for (int i = 0; i < kSkyDirections; ++i) {
    float extinction = 1.0f;
    vec3 scattering = vec3(1.0f / float(kSkyDirections));
    float unhiddenScattering = 1.0f / float(kSkyDirections);
    float g = phaseMeanCosine(vec3(params.phase));
    vec3 radiance = environmentRadiance(toSkies[i]);
    for (int m = 0; m <= params.counts.y; ++m) {
      vec3 light = scattering * radiance * lessened((extinction * columns[i]) * vec3(params.sigmaT));
      even += light;
      unhidden += unhiddenScattering * radiance;
      slope += (3.0f * g * dot(light, vec3(1.0f / 3.0f))) * toSkies[i];
      extinction *= params.octaves.x;
      scattering *= again;
      unhiddenScattering *= params.octaves.y;
      g *= params.octaves.z;
    }
  }
  // Shares of the same few directions err the less, and not at all where nothing hides the sky.
  sky0 = vec4(skyKept(even / max(unhidden, vec3(1e-30f))), 0.0f);
  sky1 = vec4(slopeKept(slope / max(dot(even, vec3(1.0f / 3.0f)), 1e-30f)), 0.0f);
  open = vec4(skyKept(openness), 0.0f);
}
