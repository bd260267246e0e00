// The lattice kernel without SIMD, in the operations and the order of the SIMD ones, so that the bits are
// theirs. A part of noise_lattice.cpp, which includes it inside the namespace of its scalar target; it
// includes nothing.

struct BlockAxis {
  float place[kBlockEdge], weight[kBlockEdge];
  int32_t cell[kBlockEdge];
};

void setAxis(double origin, double cellSize, float step, BlockAxis& axis) {
  const CellPlace start = cellPlace(origin, cellSize);
  for (int n = 0; n < kBlockEdge; ++n) {
    const float along = start.fraction + float(n) * step;
    const float whole = std::floor(along);
    axis.place[n] = along - whole;
    axis.weight[n] = shared::fadeQuintic(axis.place[n]);
    axis.cell[n] = cellAfter(start.cell, whole);
  }
}

float mix(float a, float b, float t) { return a + t * (b - a); }

/// The gradient of a lattice point.
glm::vec3 gradientOf(const NoiseOctave& octave, int32_t x, int32_t y, int32_t z) {
  const uint32_t hash =
      shared::hashCorner({shared::foldCell(x, octave.period), shared::foldCell(y, octave.period),
                          shared::foldCell(z, octave.period)},
                         octave.seed);
  if (octave.turn.evolves) return shared::turnedGradient(hash, octave.turn.at);
  const uint32_t gradient = hash >> 28;
  return {kGradientX[gradient], kGradientY[gradient], kGradientZ[gradient]};
}

/// a + b · (z − k) at one corner k along z, mixed over the four corners of x and y.
void mixCorners(const NoiseOctave& octave, const BlockAxis& ax, int i, const BlockAxis& ay, int j, int32_t k,
                float& a, float& b) {
  const float dx0 = ax.place[i], dx1 = dx0 - 1.0f, sx = ax.weight[i];
  float u[2], v[2], w[2];
  for (int y = 0; y < 2; ++y) {
    const int32_t cellY = cellAfter(ay.cell[j], float(y));
    const glm::vec3 g0 = gradientOf(octave, ax.cell[i], cellY, k);
    const glm::vec3 g1 = gradientOf(octave, cellAfter(ax.cell[i], 1.0f), cellY, k);
    u[y] = mix(g0.x * dx0, g1.x * dx1, sx);
    v[y] = mix(g0.y, g1.y, sx);
    w[y] = mix(g0.z, g1.z, sx);
  }
  const float dy0 = ay.place[j], dy1 = dy0 - 1.0f, sy = ay.weight[j];
  a = mix(u[0] + v[0] * dy0, u[1] + v[1] * dy1, sy);
  b = mix(w[0], w[1], sy);
}

void addBlock(const NoiseOctave& octave, const BlockAxis& ax, const BlockAxis& ay, const BlockAxis& az,
              float* sums) {
  const float weight = octave.weight * noiseScale(octave);
  for (int i = 0; i < kBlockEdge; ++i)
    for (int j = 0; j < kBlockEdge; ++j)
      for (int k = 0; k < kBlockEdge; ++k) {
        float a0, b0, a1, b1;
        mixCorners(octave, ax, i, ay, j, az.cell[k], a0, b0);
        mixCorners(octave, ax, i, ay, j, cellAfter(az.cell[k], 1.0f), a1, b1);
        const float dz0 = az.place[k], dz1 = dz0 - 1.0f;
        sums[i * 64 + j * 8 + k] += weight * mix(a0 + b0 * dz0, a1 + b1 * dz1, az.weight[k]);
      }
}
