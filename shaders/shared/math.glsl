// Functions that language libraries round each in their own way, written out, so that every target gives the same bits.

// e^x, within 3e-7 of its value for −87 ≤ x ≤ 88; 0 below (the smallest normal float is e^−87.34), infinity above. NaN stays
// NaN. x = k ln 2 + r with |r| ≤ ½ ln 2, ln 2 in two parts whose products with k are exact or small [Cody and Waite 1980],
// e^r by its series, cut where the rest is below 6e-9.
NPH_FN float exponential(float x) {
  if (x != x) return x;
  if (x < -87.0f) return 0.0f;
  if (x > 88.0f) return uintBitsToFloat(0x7f800000u);
  float k = floor(x * 1.44269504f + 0.5f);  // 1/ln 2
  float r = (x - k * 0.693359375f) - k * -2.12194440e-4f;
  float series = 1.0f / 720.0f + r * (1.0f / 5040.0f);
  series = 1.0f / 120.0f + r * series;
  series = 1.0f / 24.0f + r * series;
  series = 1.0f / 6.0f + r * series;
  series = 0.5f + r * series;
  float power = 1.0f + (r + r * r * series);
  return power * uintBitsToFloat(uint(int(k) + 127) << 23u);  // 127: the exponent's bias, 23: its place
}

// (sin x, cos x), within 1.2e-7 of their values for |x| ≤ 8000; beyond, the angle itself has lost its digits. x = k π/2 + r with
// |r| ≤ π/4, π/2 in three parts whose products with k are exact or small; minimax polynomials on the rest [Moshier, Cephes].
NPH_FN vec2 sineCosine(float x) {
  float k = floor(x * 0.636619772f + 0.5f);  // 2/π
  float r = ((x - k * 1.5703125f) - k * 4.83751297e-4f) - k * 7.54978995e-8f;
  float z = r * r;
  float s = r + r * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
  float c = 1.0f - 0.5f * z + z * z * (4.166664568e-2f + z * (-1.388731625e-3f + z * 2.443315712e-5f));
  int quadrant = int(k) & 3;
  vec2 turned = (quadrant & 1) == 0 ? vec2(s, c) : vec2(c, -s);
  return (quadrant & 2) == 0 ? turned : -turned;
}
