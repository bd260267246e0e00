// Powder, or ambient out-scattering [Nurage]: what dense parts lose of the light that they scatter. Not physical. Needs
// remap.glsl before it.

// The factor of in-scattering, in [0, 1]: OS = 1 − sat(strength · d^R(h, 0.3, 0.9, 0.5, 1)) · sat(R(h, 0, 0.3, 0.8, 1))^0.8,
// d the density over the grid's largest, in (0, 1], h the height in the cloud, 0 at its base and 1 at its top.
NPH_FN float powderFactor(float strength, float d, float h) {
  float lost = clamp(strength * pow(d, remapRange(h, 0.3f, 0.9f, 0.5f, 1.0f)), 0.0f, 1.0f);
  return 1.0f - lost * pow(clamp(remapRange(h, 0.0f, 0.3f, 0.8f, 1.0f), 0.0f, 1.0f), 0.8f);
}
