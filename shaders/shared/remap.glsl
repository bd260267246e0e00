// The report's remap [Nurage].

// R(v, l0, h0, ln, hn) = ln + (v' − l0)(hn − ln)/(h0 − l0), v' = v clamped between the lesser and the greater of l0, h0.
// Reversed ranges are legal; l0 = h0 is the caller's error.
NPH_FN float remapRange(float v, float l0, float h0, float ln, float hn) {
  float held = clamp(v, min(l0, h0), max(l0, h0));
  return ln + (held - l0) * (hn - ln) / (h0 - l0);
}
