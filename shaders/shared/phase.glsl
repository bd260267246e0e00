// Phase functions, per steradian. Directions, once for the whole project: `ray` runs from the camera into the scene,
// `toLight` from the sample to the light, and cosθ = dot(toLight, ray) is 1 when looking at the light; g > 0 brightens
// back-lit clouds. Unit vectors.

NPH_CONST float kPi = 3.14159265358979f;

// 1/(4π) [MODEL.md, section 2].
NPH_FN float phaseIsotropic() { return 0.25f / kPi; }

// Henyey–Greenstein, −1 < g < 1, integrates to 1 over the sphere, mean cosine g. Written with half the squared
// distance between the directions instead of 1 − cosθ: the textbook form loses a third at g = 0.999 in float.
NPH_FN float phaseHenyeyGreenstein(vec3 toLight, vec3 ray, float g) {
  float forward = g < 0.0f ? -1.0f : 1.0f;
  float size = abs(g);
  vec3 apart = toLight - forward * ray;
  float h = 0.5f * dot(apart, apart);
  float base = (1.0f - size) * (1.0f - size) + 2.0f * size * h;
  return (1.0f - size) * (1.0f + size) / (4.0f * kPi * base * sqrt(base));
}

// The project's one phase function: mix(HG(x), HG(y), z) over the lobes (x, y, z), which integrates to 1 like its parts.
// (g, 0, 0) is Henyey–Greenstein; (in_s, −out_s, blend) is silver lining plus [Nurage].
NPH_FN float phaseFunction(vec3 toLight, vec3 ray, vec3 lobes) {
  float first = phaseHenyeyGreenstein(toLight, ray, lobes.x);
  if (lobes.z <= 0.0f) return first;
  return (1.0f - lobes.z) * first + lobes.z * phaseHenyeyGreenstein(toLight, ray, lobes.y);
}

// Its mean cosine.
NPH_FN float phaseMeanCosine(vec3 lobes) { return (1.0f - lobes.z) * lobes.x + lobes.z * lobes.y; }

// A direction to the light drawn from Henyey–Greenstein about `ray` by two uniforms in [0, 1) [PBRT, 11.3.1].
NPH_FN vec3 sampleHenyeyGreenstein(vec3 ray, float g, float u1, float u2) {
  // Below this the inversion divides by almost 0 while the lobe is uniform to the same order.
  float cosTheta = 1.0f - 2.0f * u1;
  if (abs(g) > 1e-3f) {
    float s = (1.0f - g * g) / (1.0f + g - 2.0f * g * u1);
    cosTheta = clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
  }
  float sinTheta = sqrt(max(0.0f, 1.0f - cosTheta * cosTheta));
  float angle = 2.0f * kPi * u2;
  vec3 helper = abs(ray.z) < 0.9f ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
  vec3 tangent = normalize(cross(helper, ray));
  vec3 bitangent = cross(ray, tangent);
  return cosTheta * ray + sinTheta * (cos(angle) * tangent + sin(angle) * bitangent);
}

// A direction to the light drawn from the phase function; u1 also chooses the lobe.
NPH_FN vec3 samplePhaseFunction(vec3 ray, vec3 lobes, float u1, float u2) {
  if (u1 < lobes.z) return sampleHenyeyGreenstein(ray, lobes.y, u1 / lobes.z, u2);
  return sampleHenyeyGreenstein(ray, lobes.x, (u1 - lobes.z) / (1.0f - lobes.z), u2);
}
