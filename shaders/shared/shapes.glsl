// Shapes as signed distances (negative inside, world units) and the envelope that turns a distance into a density.

// Distance to a sphere about the origin.
NPH_FN float distanceToSphere(vec3 p, float radius) { return length(p) - radius; }

// 1 where the surface is at least `falloff` away on the inside, 0 on the surface and outside, linear between [Nurage].
// falloff 0 is a hard edge.
NPH_FN float envelope(float signedDistance, float falloff) {
  if (falloff <= 0.0f) return signedDistance < 0.0f ? 1.0f : 0.0f;
  return clamp(-signedDistance / falloff, 0.0f, 1.0f);
}
