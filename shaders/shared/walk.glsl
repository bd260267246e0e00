// Ways through the bricks: density at a point, columns of density along a line. Included at GLSL's global scope, and in C++
// inside a struct, which provide
//   MarchParameters params;
//   uint brickSlot(ivec3 brick);                    0: no density in the brick, which lies inside the brick grid
//   float brickDensity(uint slot, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in voxels

NPH_CONST float kBrickEdge = 8.0f;

// Density at an index-space position. Where its brick is empty, `toExit` becomes the number of `stride`s from there to the
// brick's far face, over which all densities are 0; otherwise it is 0.
NPH_FN float densityAndExit(vec3 position, vec3 stride, NPH_OUT(float) toExit) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  toExit = 0.0f;
  bool outside = brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.brickCount.x ||
                 brick.y >= params.brickCount.y || brick.z >= params.brickCount.z;
  // Rounding may place an end of the ray a hair outside the box, where the density is 0.
  if (outside) return 0.0f;
  uint slot = brickSlot(brick);
  vec3 corner = vec3(brick) * kBrickEdge;
  if (slot != 0u) return brickDensity(slot, position - corner);
  toExit = 1e9f;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(stride[axis]) > 1e-9f) {
      float face = stride[axis] > 0.0f ? corner[axis] + kBrickEdge : corner[axis];
      toExit = min(toExit, (face - position[axis]) / stride[axis]);
    }
  }
  return 0.0f;
}

// ∫ ρ ds in world units from `origin` along `direction` (index units per world unit) over at most `reach` world units, by
// steps that grow with the way gone: what lies far from a point shades its neighbours alike. Empty bricks are passed without
// reading them, on the same steps. Gives up, with what it has, once it exceeds `enough`.
NPH_FN float columnDensity(vec3 origin, vec3 direction, float reach, float enough, float start,
                           NPH_INOUT(vec2) cost) {
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return 0.0f;
  tFar = min(tFar, reach);
  float dt = params.shadow.x / length(direction);
  float growth = params.shadow.y;
  float column = 0.0f;
  float t = tNear;
  // Kept apart from the loop's condition, which a compiler may take to be false behind the loop.
  float arrived = t < tFar ? 0.0f : 1.0f;
  while (t < tFar) {               // false also where t is NaN
    float ds = min(dt, tFar - t);  // the last step ends where the medium does
    float middle = t + start * ds;
    float toExit = 0.0f;
    column += densityAndExit(origin + middle * direction, direction, toExit) * ds;
    cost.x += 1.0f;
    arrived = column > enough ? 1.0f : 0.0f;
    if (column > enough) break;
    t += ds;
    dt *= growth;
    // Steps whose reading lies in the same empty brick, a thousandth of a step before its end at most.
    float end = min(middle + toExit, tFar) - 1e-3f * dt;
    while (t + start * dt < end) {
      t += dt;
      dt *= growth;
    }
    arrived = t < tFar ? 0.0f : 1.0f;
  }
  cost.y = max(cost.y, 1.0f - arrived);
  return column;
}
