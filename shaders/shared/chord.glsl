// Light transmittance by the chord [Nurage].

// Length inside the ellipsoid about `centre` with semi-axes `radii` of the ray origin + t · direction, 0 ≤ t ≤ reach, in
// multiples of `direction`. 0 where they do not meet.
NPH_FN float ellipsoidChord(vec3 origin, vec3 direction, vec3 centre, vec3 radii, float reach) {
  vec3 o = (origin - centre) / radii;
  vec3 d = direction / radii;
  float dd = dot(d, d);
  float middle = -dot(o, d) / dd;
  // The squared distance of the ray's nearest point from the centre: o² − (o·d)²/d² would cancel.
  vec3 nearest = o + middle * d;
  float inside = 1.0f - dot(nearest, nearest);
  if (inside <= 0.0f) return 0.0f;
  float extent = sqrt(inside / dd);
  return max(0.0f, min(middle + extent, reach) - max(middle - extent, 0.0f));
}
