// Set operations on densities as on fuzzy sets [Zadeh 1965]: greatest, least, and least with the complement. They are those
// of sets where densities are 0 or 1, obey De Morgan, and a set united or intersected with itself stays the same. Negative
// inputs count as 0.

NPH_FN float uniteDensities(float a, float b) { return max(max(a, b), 0.0f); }
NPH_FN float intersectDensities(float a, float b) { return max(min(a, b), 0.0f); }
// a without b: min(a, max(a, 1)(1 − b)), b held within [0, 1]. The complement of b is taken in a set that is as dense as a,
// or 1: where b is 0 a is left as it is, where b is 1 nothing is, and up to density 1 it is min(a, 1 − b). It grows with a.
NPH_FN float subtractDensity(float a, float b) {
  return max(min(a, max(a, 1.0f) * (1.0f - clamp(b, 0.0f, 1.0f))), 0.0f);
}

// The greater of both, raised by (k − |a − b|)²/(4k) where they differ by less than k: the quadratic smooth maximum
// [Quilez]. k is `blend`, but at most the lesser input, so that what one of them lacks is left as it is and 0 stays 0; the
// result is never below either input, and above 1 only where one of them is. It grows with both inputs.
NPH_FN float uniteSmoothly(float a, float b, float blend) {
  float most = uniteDensities(a, b);
  float least = intersectDensities(a, b);
  float k = min(blend, least);
  float near = k - (most - least);
  if (near <= 0.0f) return most;
  return min(most + near * near / (4.0f * k), max(most, 1.0f));
}
