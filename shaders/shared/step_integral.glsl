// Step integration that conserves energy at any optical depth of a step [Hillaire 2016].

// φ(x) = (1 − e^(−x))/x for x ≥ 0: the mean of e^(−s) for s in [0, x], so that a step of optical depth x adds
// e^(−τ) · S · ρ Δs · φ(x). Below 0.03 the series: the quotient alone loses 39% at depth 1e-4 in 512 steps.
NPH_FN float stepIntegral(float x) {
  if (x < 0.03f) {
    return 1.0f - x * (0.5f - x * (0.166666667f - x * 0.0416666667f));
  }
  return (1.0f - exp(-x)) / x;
}
NPH_FN vec3 stepIntegral(vec3 x) { return vec3(stepIntegral(x.x), stepIntegral(x.y), stepIntegral(x.z)); }
