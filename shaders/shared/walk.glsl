// Ways through the bricks: what a word of the index says, density at a point, columns of density along a line. Included at
// GLSL's global scope, and in C++ inside a struct, which provide
//   MarchParameters params;
//   uint brickWord(ivec3 brick);                    of a brick inside the index: see volume/brick_layout.h
//   float brickDensity(uint word, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in its voxels

NPH_CONST float kBrickEdge = 8.0f;
NPH_CONST int kMostCode = 31;

NPH_FN bool wordIsEmpty(uint word) { return word < 0x08000000u; }

// No sample of the brick exceeds this.
NPH_FN float wordMaximum(uint word) { return params.walk.y * exp2(0.5f * float(int(word >> 27u) - kMostCode)); }

// The share of the brick's maximum that no sample falls below.
NPH_FN float wordMinimumShare(uint word) {
  uint code = (word >> 25u) & 3u;
  return code == 0u ? 0.0f : (code == 1u ? 0.5f : (code == 2u ? 0.875f : 1.0f));
}

// Edge of the cube that a word speaks of, bricks: of the empty cube, or of the brick at its level.
NPH_FN int wordEdge(uint word) { return 1 << int(wordIsEmpty(word) ? word : (word >> 23u) & 3u); }

NPH_FN bool isOutside(ivec3 brick) {
  return brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.brickCount.x || brick.y >= params.brickCount.y ||
         brick.z >= params.brickCount.z;
}

// Index-space corner of the aligned cube of `edge` bricks around a brick.
NPH_FN vec3 cubeCorner(ivec3 brick, int edge) { return vec3(brick - (brick & ivec3(edge - 1))) * kBrickEdge; }

// Way along `direction` from `position` to where it leaves the cube, in multiples of `direction`.
NPH_FN float wayOut(vec3 position, vec3 direction, vec3 corner, float size) {
  float way = 1e9f;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(direction[axis]) > 1e-9f) {
      float face = direction[axis] > 0.0f ? corner[axis] + size : corner[axis];
      way = min(way, (face - position[axis]) / direction[axis]);
    }
  }
  return way;
}

// Density at an index-space position. Where it is empty there, `toExit` becomes the number of `stride`s from there to the far
// face of the largest known empty cube, over which all densities are 0; otherwise it is 0.
NPH_FN float densityAndExit(vec3 position, vec3 stride, NPH_OUT(float) toExit) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  toExit = 0.0f;
  // Rounding may place an end of the ray a hair outside the box, where the density is 0.
  if (isOutside(brick)) return 0.0f;
  uint word = brickWord(brick);
  int edge = wordEdge(word);
  vec3 corner = cubeCorner(brick, edge);
  if (!wordIsEmpty(word)) return brickDensity(word, (position - corner) / float(edge));
  toExit = wayOut(position, stride, corner, kBrickEdge * float(edge));
  return 0.0f;
}

// ∫ ρ ds in world units from `origin` along `direction` (index units per world unit) over at most `reach` world units, by
// steps that grow with the way gone: what lies far from a point shades its neighbours alike. Empty bricks are passed without
// reading them, on the same steps. `steps` is the first one's length, voxels, and the growth of each over the one before. Gives
// up, with what it has, once it exceeds `enough`.
NPH_FN float columnDensity(vec3 origin, vec3 direction, float reach, float enough, vec2 steps, float start,
                           NPH_INOUT(vec2) cost) {
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return 0.0f;
  tFar = min(tFar, reach);
  float dt = steps.x / length(direction);
  float growth = steps.y;
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
    // Steps whose reading lies in the same empty cube, a thousandth of a step before its end at most.
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
