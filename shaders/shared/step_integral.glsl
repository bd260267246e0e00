// Step integration that conserves energy at any optical depth of a step [Hillaire 2016].

// φ(x) = (1 − e^(−x))/x for x ≥ 0: the mean of e^(−s) for s in [0, x], so that a step of optical depth x adds
// e^(−τ) · S · ρ Δs · φ(x). Below 0.03 the series: the quotient alone loses 39% at depth 1e-4 in 512 steps.
NPH_FN float stepIntegral(float x) {
  if (x < 0.03f) {
    return 1.0f - x * (0.5f - x * (0.166666667f - x * 0.0416666667f));
  }
  return (1.0f - exp(-x)) / x;
}
// ∫ e^(−τ) ρ ds over a step of column `amount`, optical depth x, from transmittance `before` to `left` = before · e^(−x): the
// same without another exponential.
NPH_FN float stepWeight(float amount, float x, float before, float left) {
  float series = amount * before * (1.0f - x * (0.5f - x * (0.166666667f - x * 0.0416666667f)));
  return x < 0.03f ? series : amount * (before - left) / max(x, 0.03f);
}
NPH_FN vec3 stepWeight(float amount, vec3 x, vec3 before, vec3 left) {
  return vec3(stepWeight(amount, x.x, before.x, left.x), stepWeight(amount, x.y, before.y, left.y),
              stepWeight(amount, x.z, before.z, left.z));
}
NPH_FN vec3 stepIntegral(vec3 x) { return vec3(stepIntegral(x.x), stepIntegral(x.y), stepIntegral(x.z)); }
