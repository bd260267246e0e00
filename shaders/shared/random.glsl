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

// The state of a sequence: equal for equal pixel (or particle), number and seed.
NPH_FN uint randomState(uint x, uint y, uint number, uint seed) {
  return hashBits(x ^ hashBits(y ^ hashBits(number ^ hashBits(seed))));
}

// The next number in [0, 1), a multiple of 2^-24.
NPH_FN float nextUniform(NPH_INOUT(uint) state) {
  state = hashBits(state + 0x9e3779b9u);
  return float(state >> 8u) * (1.0f / 16777216.0f);
}

NPH_FN uint reversedBits(uint x) {
  x = (x << 16u) | (x >> 16u);
  x = ((x & 0x00ff00ffu) << 8u) | ((x >> 8u) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4u) | ((x >> 4u) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2u) | ((x >> 2u) & 0x33333333u);
  return ((x & 0x55555555u) << 1u) | ((x >> 1u) & 0x55555555u);
}

// Digits each changed by `seed` and by those below it alone (Laine and Karras, "Stratified sampling for stochastic
// transparency", 2011): nested uniform scrambling, of digits in reverse.
NPH_FN uint scrambledBits(uint x, uint seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  return x ^ (x * 0x8d22f6e6u);
}

// Another order of all numbers, in which each aligned run of 2^k is again such a run, shuffled. A sequence taken in such an
// order stays as even, and knows nothing of the sample's other sequences: two that go on in step cover a line of the square,
// not the square.
NPH_FN uint shuffledNumber(uint number, uint seed) {
  return reversedBits(scrambledBits(reversedBits(number), seed));
}

// Place `number` in [0, 1)² of a sequence whose first 2^k places, and each aligned run of so many, have one in each box of
// every grid of 2^k equal boxes: Sobol's first two dimensions, of which the second is Pascal's triangle modulo 2, scrambled
// by `seed` (Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995).
NPH_FN vec2 evenPlace(uint number, uint seed) {
  uint pascal = number ^ ((number >> 1u) & 0x55555555u);
  pascal ^= (pascal >> 2u) & 0x33333333u;
  pascal ^= (pascal >> 4u) & 0x0f0f0f0fu;
  pascal ^= (pascal >> 8u) & 0x00ff00ffu;
  pascal ^= (pascal >> 16u) & 0x0000ffffu;
  uint seed2 = hashBits(seed);
  uint x = reversedBits(scrambledBits(number, seed2));
  uint y = reversedBits(scrambledBits(pascal, hashBits(seed2)));
  return vec2(float(x >> 8u), float(y >> 8u)) * (1.0f / 16777216.0f);
}

// The next of a state's numbers for sample `number`, in [0, 1): over samples such a number covers them evenly.
NPH_FN float nextEven(NPH_INOUT(uint) state, uint number) {
  state = hashBits(state + 0x9e3779b9u);
  return float(reversedBits(scrambledBits(number, state)) >> 8u) * (1.0f / 16777216.0f);
}

// The run of samples that one belongs to, a power of two: they are as long as what went before, so that a sum that ends with a
// run has most of its samples in few even sets.
NPH_CONST uint kShortestRun = 8u;
NPH_FN uint runOf(uint number) {
  uint bits = number | kShortestRun;
  bits |= bits >> 1u;
  bits |= bits >> 2u;
  bits |= bits >> 4u;
  bits |= bits >> 8u;
  bits |= bits >> 16u;
  return (bits >> 1u) + 1u;
}

// Edge of the tile of blue noise that starts steps apart from those of neighbouring pixels (base/blue_noise.h).
NPH_CONST int kJitterTile = 64;
