// Thermal emission from a grid of temperatures [MODEL.md, section 2]. Included as walk.glsl is, after it; GLSL's scope or the
// struct provides
//   uvec2 heatWord(ivec3 brick);                  of the temperatures' own index: see volume/brick_layout.h
//   float heatValue(uvec2 word, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in its voxels

// Below, nothing that is seen is emitted: scene/blackbody.h. The table runs evenly over √(this / T), from 0 to 1.
NPH_CONST float kColdestKelvin = 500.0f;
// Planck's exponent at 610 nm, where what is barely hot glows, in kelvin: the table holds what it leaves.
NPH_CONST float kPlanckKelvin = 23586.5f;

// 1/(e^x − 1) for x > 0; by its series where the difference would cancel.
NPH_FN float planckFactor(float x) { return x < 0.01f ? 1.0f / (x * (1.0f + 0.5f * x)) : 1.0f / (exp(x) - 1.0f); }

// Radiance of a black body in linear Rec.709, in units of its luminance at 2000 K, within 1e-3 of its largest channel.
NPH_FN vec3 blackbodyRadiance(float kelvin) {
  if (!(kelvin > kColdestKelvin)) return vec3(0.0f);
  float place = float(kBlackbodyNodes - 1) * sqrt(kColdestKelvin / kelvin);
  int node = min(int(place), kBlackbodyNodes - 2);
  vec3 left = mix(vec3(params.blackbody[node]), vec3(params.blackbody[node + 1]), place - float(node));
  return planckFactor(kPlanckKelvin / kelvin) * left;
}

// Temperature at an index-space position of the density, in units of its grid; 0 where that holds nothing.
NPH_FN float temperatureAt(vec3 position) {
  vec3 p = vec3(dot(position, vec3(params.heatX)) + params.heatX.w, dot(position, vec3(params.heatY)) + params.heatY.w,
                dot(position, vec3(params.heatZ)) + params.heatZ.w);
  ivec3 brick = ivec3(floor(p / kBrickEdge));
  if (brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.heatCount.x || brick.y >= params.heatCount.y ||
      brick.z >= params.heatCount.z)
    return 0.0f;
  uvec2 word = heatWord(brick);
  if (wordIsEmpty(word)) return 0.0f;
  int edge = wordEdge(word);
  return heatValue(word, (p - cubeCorner(brick, edge)) / float(edge));
}

// What a place emits per unit density and world unit: σ_a · scale · B(T · temperature scale).
NPH_FN vec3 emissionAt(vec3 position) {
  vec3 sigmaA = vec3(params.sigmaT) - vec3(params.sigmaS);
  return params.emission.x * sigmaA * blackbodyRadiance(params.emission.y * temperatureAt(position));
}
