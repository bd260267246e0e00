// What reaches a point of the medium from lights and sky, and how much of it is scattered along a ray [MODEL.md, section 2].
// Included as march.glsl is, after walk.glsl and environment.glsl. Some drivers run the branches that no pixel takes: what the
// parameters do not ask for is left out by NPH_POINTS, NPH_POWDER and NPH_LOBES (point lights, powder, a second lobe), which
// are true wherever it is not known. NPH_OPEN is false where octaves do not ask how open a place is.

// What an order scatters of the one before, at a place of that openness: light that leaves is not scattered again.
NPH_FN vec3 scatteredAgain(vec3 openness) { return params.octaves.y * (vec3(1.0f) - params.octaves.w * openness); }

// Σ over orders of again^m · phase(c^m g) · e^(−a^m σ_t column), to be multiplied by σ_s and the light's irradiance.
NPH_FN vec3 scatteredByOrders(vec3 toLight, vec3 ray, float column, vec3 again) {
  vec3 sum = vec3(0.0f);
  float extinction = 1.0f;
  vec3 scattering = vec3(1.0f);
  vec3 lobes = vec3(params.phase);
  for (int m = 0; m <= params.counts.y; ++m) {
    float phase = NPH_LOBES ? phaseFunction(toLight, ray, lobes) : phaseHenyeyGreenstein(toLight, ray, lobes.x);
    sum += scattering * phase * lessened((extinction * column) * vec3(params.sigmaT));
    extinction *= params.octaves.x;
    scattering *= again;
    lobes.x *= params.octaves.z;
    lobes.y *= params.octaves.z;
  }
  return sum;
}

// The column beyond which no order up to `orders` lets through more than `smallest` of the light.
NPH_FN float columnThatHides(float smallest, int orders) {
  float extinction = min(params.sigmaT.x, min(params.sigmaT.y, params.sigmaT.z));
  for (int m = 0; m < orders; ++m) extinction *= params.octaves.x;
  // 1e30: with no extinction nothing hides.
  return extinction > 0.0f ? min(-log(smallest) / extinction, 1e30f) : 1e30f;
}

// Further than any medium.
NPH_CONST float kSunReach = 3.0e38f;

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
  l.reach = kSunReach;
  l.irradiance = vec3(params.lights[i].power);
  if (NPH_POINTS && int(params.lights[i].direction.w) == kLightPoint) {
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

// So many places along a ray look towards the sky by one even set of directions, each by a part of its own that is even too:
// what one sees is much like what the next does, so that their errors fall as of so many times the samples.
NPH_CONST uint kPlacesOfASet = 16u;

// One direction to the sky: half of them follow the phase function, half are uniform, so that the weight stays bounded for
// all orders; from a map, half of all follow its brightness instead. Each run of samples has its sets, in an order that knows
// nothing of a sample's other numbers; `random` is the ray's state, `place` counts the places that are lit along it. Rays
// that looked the same way together would make pictures of few samples too bright or too dark as a whole.
NPH_FN Lighting lightingFromSky(vec3 ray, uint random, uint number, uint place) {
  uint run = runOf(number);
  uint seed = hashBits(random ^ hashBits((place / kPlacesOfASet) ^ (number & ~(run - 1u))));
  uint ofSet = place % kPlacesOfASet;
  uint turn = (shuffledNumber(number, seed) ^ ofSet) & (run - 1u);
  bool map = NPH_MAP && skyKind() == kSkyMap;
  bool byMap = map && (turn & 1u) != 0u;
  if (map && !byMap) {
    turn = turn >> 1u;
    run = run >> 1u;
  }
  bool byPhase = (turn & 1u) == 0u;
  vec2 u = evenPlace((turn >> 1u) + ofSet * (run >> 1u), byPhase ? seed : ~seed);
  vec3 lobes = vec3(params.phase);
  Lighting l;
  if (byMap) {
    uint bits = uint(u.x * 16777216.0f) * 256u;
    uint state = bits;
    l.toLight = drawFromMap(bits, nextUniform(state), u.y);
  } else if (byPhase) {
    l.toLight = samplePhaseFunction(ray, lobes, u.x, u.y);
  } else {
    l.toLight = sampleHenyeyGreenstein(ray, 0.0f, u.x, u.y);
  }
  l.toLightIndex = l.toLight.x * vec3(params.indexFromWorldX) + l.toLight.y * vec3(params.indexFromWorldY) +
                   l.toLight.z * vec3(params.indexFromWorldZ);
  l.reach = kSunReach;
  float density = 0.5f * phaseFunction(l.toLight, ray, lobes) + 0.5f * phaseIsotropic();
  if (map) density = 0.5f * density + 0.5f * mapDensity(l.toLight);
  l.irradiance = environmentRadiance(l.toLight) / density;
  return l;
}

// ∫ ρ ds from a point of density `rho` to a light, by the way that the scene chooses: marched, or the chord at the mean density.
// What is read at the share `start` of each step errs by (½ − start) Σ ds Δρ, which summation by parts makes of what is known: the
// density here, none where the medium ends, and the steps' growth. Without it light would come out too bright by its mean over
// starts, since e^(−x) is convex. At a light of limited reach the density is not known.
NPH_FN float columnTowards(vec3 position, float rho, vec3 direction, float reach, float enough, float start, NPH_INOUT(vec4) cost) {
  if (params.chordRadii.w > 0.0f)
    return params.chordCentre.w *
           ellipsoidChord(position, direction, vec3(params.chordCentre), vec3(params.chordRadii), reach);
  vec2 steps = vec2(params.shadow.x * voxelAt(position, 1.0f), params.shadow.y);
  float column = columnDensity(position, direction, reach, enough, steps, start, cost);
  float ends = rho * steps.x / length(direction) + (1.0f - 1.0f / steps.y) * column;
  return reach < kSunReach ? column : max(column + (start - 0.5f) * ends, 0.0f);
}

// What powder leaves of the light that a place of density `rho` scatters.
NPH_FN float powderAt(vec3 position, float rho) {
  if (!NPH_POWDER || params.powder.x <= 0.0f) return 1.0f;
  float height = dot(position, vec3(params.height)) + params.height.w;
  return powderFactor(params.powder.x, min(rho * params.powder.y, 1.0f), height);
}

// Source function at a point of density `rho`: Σ over lights and the sky, per unit density, before σ_s. `random` is the ray's
// state, `number` the picture's sample, `place` counts the places that are lit along the ray. What the light cache holds is
// taken from there: NPH_CACHED is true where it has the lights' columns, NPH_NEAR where the way to it is marched; NPH_SKY is 0
// where there is no sky, 1 where the cache has it, 2 where it is marched for.
NPH_FN vec3 inScattering(vec3 position, float rho, vec3 ray, float enough, uint number, uint place, uint random, NPH_INOUT(vec4) cost) {
  // Each place has numbers of its own, so that more or fewer drawn at another do not change them.
  uint placeRandom = hashBits(random ^ place);
  vec3 sum = vec3(0.0f);
  vec3 again = NPH_OPEN ? scatteredAgain(opennessAt(position)) : vec3(params.octaves.y);
  int count = params.counts.x + (NPH_SKY == 2 ? 1 : 0);
  int done = 0;
  for (int i = 0; i < count; ++i) {
    float start = params.counts.w != 0 ? nextEven(placeRandom, number) : 0.5f;
    bool sky = NPH_SKY == 2 && i == params.counts.x;
    Lighting l;
    if (sky) {
      l = lightingFromSky(ray, random, number, place);
    } else {
      l = lightingFrom(i, position);
    }
    float column = 0.0f;
    if (NPH_CACHED && !sky) {
      column = lightColumn(i, position, l.toLightIndex, l.reach, start, cost);
    } else {
      column = columnTowards(position, rho, l.toLightIndex, l.reach, enough, start, cost);
    }
    sum += l.irradiance * scatteredByOrders(l.toLight, ray, column, again);
    done += 1;
  }
  if (done < count) cost.y = 1.0f;
  if (NPH_SKY == 1) sum += skyScattering(position, ray);
  return sum;
}
