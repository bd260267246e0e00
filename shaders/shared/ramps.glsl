// Ramps along an axis [Fournier]. Needs math.glsl before it.

// `from` where at ≤ 0, `to` where at ≥ 1, straight between; exact at both ends.
NPH_FN float linearRamp(float at, float from, float to) {
  float held = clamp(at, 0.0f, 1.0f);
  return (1.0f - held) * from + held * to;
}

// value · e^(−at), `at` in scale heights above the base; `below` · value under the base.
NPH_FN float exponentialRamp(float at, float value, float below) {
  return at < 0.0f ? below * value : value * exponential(-at);
}
