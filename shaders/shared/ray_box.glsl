// Slab test that gives the mathematical interval for direction components of +0, −0 and denormals, for origins on a
// face or inside, and for rays along an edge; never NaN.

// Ray origin + t · direction against [boxMin, boxMax]. True where they meet in more than one point at t ≥ 0; then
// tNear ≥ 0 and tFar > tNear bound the part inside. An axis along which the ray does not move (the component is 0, or
// so small that its quotient overflows) decides by the origin alone; the closed box contains its faces.
NPH_FN bool intersectBox(vec3 origin, vec3 direction, vec3 boxMin, vec3 boxMax, NPH_OUT(float) tNear,
                         NPH_OUT(float) tFar) {
  float near = 0.0f;
  float far = 3.0e38f;  // below the largest float, so that far − near stays finite
  bool hit = true;
  for (int axis = 0; axis < 3; ++axis) {
    float d = direction[axis];
    float lo = boxMin[axis] - origin[axis];
    float hi = boxMax[axis] - origin[axis];
    // 1e-30: against extents below 1e8 voxels the quotient would leave the range of float.
    if (abs(d) < 1e-30f) {
      hit = hit && lo <= 0.0f && hi >= 0.0f;
    } else {
      float t0 = lo / d;
      float t1 = hi / d;
      near = max(near, min(t0, t1));
      far = min(far, max(t0, t1));
    }
  }
  tNear = near;
  tFar = far;
  return hit && far > near;
}
