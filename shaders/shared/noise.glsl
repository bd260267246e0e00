// Noise, pointwise: the definitions that block kernels are tested against. A point comes as the integer lattice cell that
// holds it and its position in the cell, in [0, 1), so that noise keeps its precision at any distance from the origin.

// 1/1.0364: the largest |gradient noise| with the 12 edge gradients and the quintic fade is 1.03635, at (½, ½, 0.645)
// up to symmetry, where every corner's gradient pulls the same way. So |perlinNoise| ≤ 1.
NPH_CONST float kPerlinScale = 0.96487842532f;

// A lattice point and a seed in one word, not yet mixed.
NPH_FN uint cellKey(ivec3 cell, uint seed) {
  return (uint(cell.x) * 0x9e3779b1u) ^ (uint(cell.y) * 0x85ebca77u) ^ (uint(cell.z) * 0xc2b2ae3du) ^ seed;
}

// 1/1.0386: with gradients that turn in their planes (turnedGradient) the largest value is near 1.03848, at (½, 0.518, 0.350)
// up to symmetry, and certainly below 1.0386 (a test splits the cell until that is shown). So |turningNoise| ≤ 1.
NPH_CONST float kTurningScale = 0.9628345f;

// Mixes a lattice point and a seed into 32 well-spread bits.
NPH_FN uint hashCell(ivec3 cell, uint seed) {
  uint h = cellKey(cell, seed);
  h ^= h >> 15u;
  h *= 0x2c1b3c6du;
  h ^= h >> 12u;
  h *= 0x297a2d39u;
  h ^= h >> 15u;
  return h;
}

// What a lattice point's gradient hangs on, in the best-mixed bits of one multiplication: the top four choose it, the two
// below say how it turns. Pairs of neighbours two cells apart and nearer are as evenly spread as with hashCell.
NPH_FN uint hashCorner(ivec3 cell, uint seed) {
  uint h = cellKey(cell, seed);
  h ^= h >> 15u;
  return h * 0x2c1b3c6du;
}

// The gradient of a lattice point, 0…15.
NPH_FN uint hashGradient(ivec3 cell, uint seed) { return hashCorner(cell, seed) >> 28u; }

// Noise evolves by what turns at its lattice points, once or twice a cycle and either way round, so that no moment of the
// cycle but its end is like its start. `turn` holds cosine and sine of the cycle's angle, then of twice the angle; two bits
// of a hash choose.
NPH_FN vec2 turnOf(uint bits, vec4 turn) {
  vec2 chosen = (bits & 1u) == 0u ? vec2(turn.x, turn.y) : vec2(turn.z, turn.w);
  return (bits & 2u) == 0u ? chosen : vec2(chosen.x, -chosen.y);
}

// A number in [−1, 1] moved on a closed orbit that starts at `start`: the first coordinate of a point on the unit sphere that
// turns about the third. If starts are even in [−1, 1] they stay so, as coordinates of even points on a sphere are; the
// second coordinate takes one of eight evenly spread longitudes, four cosines, by two bits.
NPH_FN float onOrbit(float start, uint bits, vec2 turn) {
  float cosine = (bits & 1u) == 0u ? 0.9238795325f : 0.3826834324f;  // of π/8 and 3π/8
  float second = sqrt(max(1.0f - start * start, 0.0f)) * ((bits & 2u) == 0u ? cosine : -cosine);
  return start * turn.x + second * turn.y;
}

// The seed of octave, axis or layer `number` of a noise, apart from the seeds of its neighbours.
NPH_FN uint seedApart(uint seed, int number) {
  return hashCell(ivec3(number, 0x5bd1, 0x1b87), seed);
}

// 6t⁵ − 15t⁴ + 10t³ [Perlin 2002].
NPH_FN float fadeQuintic(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

// Dot product with one of the 12 edge gradients (four of them twice, to fill 16), chosen by h in 0…15 [Perlin 2002].
NPH_FN float gradientDot(uint h, float x, float y, float z) {
  float u = h < 8u ? x : y;
  float v = h < 4u ? y : (h == 12u || h == 14u ? x : z);
  return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}

// The same gradient turned in the plane of its two axes, which keeps its length √2 [after Perlin and Neyret 2001]. `hash` is
// hashCorner's.
NPH_FN vec3 turnedGradient(uint hash, vec4 turn) {
  uint h = hash >> 28u;
  float signU = (h & 1u) == 0u ? 1.0f : -1.0f;
  float signV = (h & 2u) == 0u ? 1.0f : -1.0f;
  vec2 t = turnOf(hash >> 26u, turn);
  float u = signU * t.x - signV * t.y;
  float v = signV * t.x + signU * t.y;
  if (h < 8u) return h < 4u ? vec3(u, v, 0.0f) : vec3(u, 0.0f, v);
  return h == 12u || h == 14u ? vec3(v, u, 0.0f) : vec3(0.0f, u, v);
}

// Lattice coordinate folded into [0, period); period 0 folds nothing.
NPH_FN int foldCell(int cell, int period) {
  if (period == 0) return cell;
  int rest = cell % period;
  return rest < 0 ? rest + period : rest;
}

NPH_FN ivec3 foldedCell(ivec3 cell, int period) {
  return ivec3(foldCell(cell.x, period), foldCell(cell.y, period), foldCell(cell.z, period));
}

// A cell's corner 0…7, x fastest, then y, then z, relative to the first.
NPH_FN ivec3 cornerOffset(int corner) { return ivec3(corner & 1, (corner >> 1) & 1, corner >> 2); }

// A cell's eight corner values (x fastest, then y, then z) at the place f in it, by the quintic fade.
NPH_FN float mixCorners(float corner[8], vec3 f) {
  float sx = fadeQuintic(f.x);
  float sy = fadeQuintic(f.y);
  float sz = fadeQuintic(f.z);
  float x00 = corner[0] + sx * (corner[1] - corner[0]);
  float x10 = corner[2] + sx * (corner[3] - corner[2]);
  float x01 = corner[4] + sx * (corner[5] - corner[4]);
  float x11 = corner[6] + sx * (corner[7] - corner[6]);
  float y0 = x00 + sy * (x10 - x00);
  float y1 = x01 + sy * (x11 - x01);
  return y0 + sz * (y1 - y0);
}

// Gradient noise in [−1, 1]; 0 at lattice points. `period` in cells for all axes, 0 for none [Perlin 1985, 2002].
NPH_FN float perlinNoise(ivec3 cell, vec3 f, int period, uint seed) {
  float corner[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    corner[c] = gradientDot(hashGradient(at, seed), f.x - float(o.x), f.y - float(o.y), f.z - float(o.z));
  }
  return mixCorners(corner, f) * kPerlinScale;
}

// Gradient noise in [−1, 1] whose gradients have turned by `turn` (turnOf); at turn (1, 0, 1, 0) it is perlinNoise but for
// its scale.
NPH_FN float turningNoise(ivec3 cell, vec3 f, int period, uint seed, vec4 turn) {
  float corner[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    vec3 g = turnedGradient(hashCorner(at, seed), turn);
    vec3 d = vec3(f.x - float(o.x), f.y - float(o.y), f.z - float(o.z));
    corner[c] = g.x * d.x + g.y * d.y + g.z * d.z;
  }
  return mixCorners(corner, f) * kTurningScale;
}

// Slope per cell along x, y, z of the noise of these gradients at a cell's corners, before its scale: the derivative of the
// same polynomial.
NPH_FN vec3 slopeOfCorners(vec3 gradient[8], vec3 f) {
  vec3 fade = vec3(fadeQuintic(f.x), fadeQuintic(f.y), fadeQuintic(f.z));
  vec3 rise = 30.0f * f * f * (f - vec3(1.0f)) * (f - vec3(1.0f));  // the fade's derivative
  vec3 slope = vec3(0.0f);
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    vec3 d = f - vec3(float(o.x), float(o.y), float(o.z));
    vec3 g = gradient[c];
    float value = g.x * d.x + g.y * d.y + g.z * d.z;
    float wx = o.x == 1 ? fade.x : 1.0f - fade.x;
    float wy = o.y == 1 ? fade.y : 1.0f - fade.y;
    float wz = o.z == 1 ? fade.z : 1.0f - fade.z;
    float rx = o.x == 1 ? rise.x : -rise.x;
    float ry = o.y == 1 ? rise.y : -rise.y;
    float rz = o.z == 1 ? rise.z : -rise.z;
    slope += vec3(rx * wy * wz, wx * ry * wz, wx * wy * rz) * value + (wx * wy * wz) * g;
  }
  return slope;
}

// Slope of perlinNoise per cell along x, y, z.
NPH_FN vec3 perlinSlope(ivec3 cell, vec3 f, int period, uint seed) {
  vec3 gradient[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    uint h = hashGradient(at, seed);
    gradient[c] =
        vec3(gradientDot(h, 1.0f, 0.0f, 0.0f), gradientDot(h, 0.0f, 1.0f, 0.0f), gradientDot(h, 0.0f, 0.0f, 1.0f));
  }
  return slopeOfCorners(gradient, f) * kPerlinScale;
}

// Slope of turningNoise per cell along x, y, z.
NPH_FN vec3 turningSlope(ivec3 cell, vec3 f, int period, uint seed, vec4 turn) {
  vec3 gradient[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    gradient[c] = turnedGradient(hashCorner(at, seed), turn);
  }
  return slopeOfCorners(gradient, f) * kTurningScale;
}

// Value noise in [−1, 1]: one random value a lattice point, quintic fade between.
NPH_FN float valueNoise(ivec3 cell, vec3 f, int period, uint seed) {
  float corner[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    // 2^-23: the hash's upper 24 bits become [0, 2).
    corner[c] = float(hashCell(at, seed) >> 8u) * 1.1920929e-7f - 1.0f;
  }
  return mixCorners(corner, f);
}

// Value noise in [−1, 1] whose values have moved on orbits (onOrbit, turnOf).
NPH_FN float turningValue(ivec3 cell, vec3 f, int period, uint seed, vec4 turn) {
  float corner[8];
  for (int c = 0; c < 8; ++c) {
    ivec3 o = cornerOffset(c);
    ivec3 at = foldedCell(cell + o, period);
    uint h = hashCell(at, seed);
    // 2^-23: the hash's upper 24 bits become [0, 2). The lower eight are free.
    corner[c] = onOrbit(float(h >> 8u) * 1.1920929e-7f - 1.0f, h, turnOf(h >> 2u, turn));
  }
  return mixCorners(corner, f);
}

// The one feature point of a cell, in [0, 1)³ from its corner: the centre for jitter 0, anywhere for 1. Multiples of 1/2048
// (along z 1/1024), which one hash holds.
NPH_FN vec3 featurePoint(ivec3 cell, float jitter, int period, uint seed) {
  uint h = hashCell(foldedCell(cell, period), seed);
  vec3 place = vec3(float(h & 0x7ffu), float((h >> 11u) & 0x7ffu), float((h >> 22u) << 1u)) * (1.0f / 2048.0f);
  return vec3(0.5f) + jitter * (place - vec3(0.5f));
}

// The same point as it moves on a closed orbit in its cell, of which it is evenly likely to be anywhere at any time (onOrbit).
NPH_FN vec3 turnedFeature(ivec3 cell, float jitter, int period, uint seed, vec4 turn) {
  uint h = hashCell(foldedCell(cell, period), seed);
  vec3 place = vec3(float(h & 0x7ffu), float((h >> 11u) & 0x7ffu), float((h >> 22u) << 1u)) * (1.0f / 2048.0f);
  // All of that hash is in use: another multiplication gives eight more bits.
  uint more = ((h ^ (h >> 15u)) * 0x2c1b3c6du) >> 24u;
  vec2 t = turnOf(more, turn);
  vec3 moved = vec3(onOrbit(2.0f * place.x - 1.0f, more >> 2u, t), onOrbit(2.0f * place.y - 1.0f, more >> 4u, t),
                    onOrbit(2.0f * place.z - 1.0f, more >> 6u, t));
  return vec3(0.5f) + (0.5f * jitter) * moved;
}

// Cellular noise: distances in cells to the nearest and second nearest of all feature points [Worley 1996]. Both are at most
// √3: the worst place is a lattice point whose eight cells hold their points in the far corners. Cells two away are
// therefore looked at, where they can be near enough; those three away never are. `turns`: points move on their orbits.
NPH_FN vec2 movingDistances(ivec3 cell, vec3 f, float jitter, int period, uint seed, bool turns, vec4 turn) {
  float first = 9.0f;  // squared; above 3
  float second = 9.0f;
  for (int x = -2; x <= 2; ++x) {
    float gapX = max(max(float(x) - f.x, f.x - float(x) - 1.0f), 0.0f);
    for (int y = -2; y <= 2; ++y) {
      float gapY = max(max(float(y) - f.y, f.y - float(y) - 1.0f), 0.0f);
      for (int z = -2; z <= 2; ++z) {
        float gapZ = max(max(float(z) - f.z, f.z - float(z) - 1.0f), 0.0f);
        if (gapX * gapX + gapY * gapY + gapZ * gapZ > second) continue;
        ivec3 at = cell + ivec3(x, y, z);
        vec3 place = turns ? turnedFeature(at, jitter, period, seed, turn) : featurePoint(at, jitter, period, seed);
        vec3 apart = vec3(float(x), float(y), float(z)) + place - f;
        float squared = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
        second = min(second, max(first, squared));
        first = min(first, squared);
      }
    }
  }
  return vec2(sqrt(first), sqrt(second));
}

// The same with feature points at rest.
NPH_FN vec2 worleyDistances(ivec3 cell, vec3 f, float jitter, int period, uint seed) {
  return movingDistances(cell, f, jitter, period, seed, false, vec4(1.0f, 0.0f, 1.0f, 0.0f));
}
