// Counter-based random numbers: the same bits in both languages, for jitter and for directions.

// A 32-bit integer hash of low bias (two rounds of xor-shift and multiply).
NPH_FN uint hashBits(uint x) {
  x ^= x >> 16u;
  x *= 0x7feb352du;
  x ^= x >> 15u;
  x *= 0x846ca68bu;
  x ^= x >> 16u;
  return x;
}

// The state of one pixel's sequence: equal for equal pixel, sample number and seed.
NPH_FN uint randomState(uint x, uint y, uint number, uint seed) {
  return hashBits(x ^ hashBits(y ^ hashBits(number ^ hashBits(seed))));
}

// The next number in [0, 1), a multiple of 2^-24.
NPH_FN float nextUniform(NPH_INOUT(uint) state) {
  state = hashBits(state + 0x9e3779b9u);
  return float(state >> 8u) * (1.0f / 16777216.0f);
}

// Edge of the tile of blue noise that starts steps apart from those of neighbouring pixels (base/blue_noise.h).
NPH_CONST int kJitterTile = 64;
