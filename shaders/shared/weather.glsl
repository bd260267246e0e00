// How the density of a cloud layer runs over its height, by type of cloud, and how coverage thins it [Schneider].

// Straight from 0 at x to 1 at y, 1 until z, straight to 0 at w; heights as shares of the layer.
NPH_FN float layerProfile(float height, vec4 g) {
  float rise = clamp((height - g.x) / (g.y - g.x), 0.0f, 1.0f);
  float fall = clamp((g.w - height) / (g.w - g.z), 0.0f, 1.0f);
  return min(rise, fall);
}

// Shares of the layer between which a type starts, is full, thins out and ends, after Schneider's gradients.
NPH_FN float stratusProfile(float height) { return layerProfile(height, vec4(0.0f, 0.05f, 0.1f, 0.2f)); }
NPH_FN float stratocumulusProfile(float height) { return layerProfile(height, vec4(0.0f, 0.2f, 0.42f, 0.6f)); }
NPH_FN float cumulusProfile(float height) { return layerProfile(height, vec4(0.0f, 0.12f, 0.7f, 1.0f)); }

// The three by type: 0 stratus, ½ stratocumulus, 1 cumulus, mixed between.
NPH_FN float mixedProfile(float stratus, float stratocumulus, float cumulus, float type) {
  float toMiddle = clamp(2.0f * type, 0.0f, 1.0f);
  float toLast = clamp(2.0f * type - 1.0f, 0.0f, 1.0f);
  return (1.0f - toMiddle) * stratus + (toMiddle - toLast) * stratocumulus + toLast * cumulus;
}

// coverage · R(profile, 1 − coverage, 1, 0, 1), in which the coverage cancels.
NPH_FN float coveredProfile(float profile, float coverage) { return max(profile + coverage - 1.0f, 0.0f); }
