// Shapes as signed distances (negative inside, world units) and the envelope that turns a distance into a density. Every
// distance here changes by at most the length of a step (Lipschitz 1), and all but the ellipsoid's are exact.

// Distance to a sphere about the origin.
NPH_FN float distanceToSphere(vec3 p, float radius) { return length(p) - radius; }

// Distance to an ellipsoid about the origin, shrunk: shortest · (|p/radii| − 1). A lower bound of the true distance on both
// sides, since its gradient is nowhere longer than 1; exact along the shortest axis. It falls evenly from the centre, where
// it is −shortest, to the surface, in every direction. `shortest` is the least of the radii.
NPH_FN float distanceToEllipsoid(vec3 p, vec3 radii, float shortest) { return shortest * (length(p / radii) - 1.0f); }

// Distance to a box about the origin with edges rounded by `rounding`; `halfSize` is half the box's edges, rounding included.
NPH_FN float distanceToBox(vec3 p, vec3 halfSize, float rounding) {
  vec3 q = abs(p) - (halfSize - vec3(rounding));
  return length(max(q, vec3(0.0f))) + min(max(q.x, max(q.y, q.z)), 0.0f) - rounding;
}

// Distance to all points within `radius` of the segment from the origin to `along`, which may have length 0.
NPH_FN float distanceToCapsule(vec3 p, vec3 along, float radius) {
  float square = dot(along, along);
  float at = square > 0.0f ? clamp(dot(p, along) / square, 0.0f, 1.0f) : 0.0f;
  return length(p - at * along) - radius;
}

// Distance to a torus about the origin: a ring of radius `major` about the unit vector `axis`, as thick as `minor` all round.
NPH_FN float distanceToTorus(vec3 p, vec3 axis, float major, float minor) {
  float height = dot(p, axis);
  float beside = length(p - height * axis) - major;
  return sqrt(beside * beside + height * height) - minor;
}

// Distance to the half-space behind the plane through the origin with the unit vector `normal`.
NPH_FN float distanceToPlane(vec3 p, vec3 normal) { return dot(p, normal); }

// 1 where the surface is at least `falloff` away on the inside, 0 on the surface and outside, linear between [Nurage].
// falloff 0 is a hard edge.
NPH_FN float envelope(float signedDistance, float falloff) {
  if (falloff <= 0.0f) return signedDistance < 0.0f ? 1.0f : 0.0f;
  return clamp(-signedDistance / falloff, 0.0f, 1.0f);
}
