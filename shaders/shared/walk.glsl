// Ways through the bricks: what a word of the index says, density at a point, columns of density along a line. Included at
// GLSL's global scope, and in C++ inside a struct, which provide
//   MarchParameters params;
//   uvec2 brickWord(ivec3 brick);                    of a brick inside the index: see volume/brick_layout.h
//   uvec2 storedWord(ivec3 brick);                   the same without empty cubes: asked where NPH_CHECK is 1
//   float brickDensity(uvec2 word, vec3 position);   trilinear; position in [0, 8] from the brick's corner, in its voxels

NPH_CONST float kBrickEdge = 8.0f;

NPH_FN bool wordIsEmpty(uvec2 word) { return (word.x >> 24u) == 0u; }

// No sample of the brick exceeds this: a code of volume/brick_bounds.h.
NPH_FN float wordMaximum(uvec2 word) { return params.walk.y * uintBitsToFloat(((word.x >> 24u) << 20u) + 0x30000000u); }

// The share of the brick's maximum that no sample falls below.
NPH_FN float wordMinimumShare(uvec2 word) { return float(word.y >> 24u) * (1.0f / 255.0f); }

// Edge of the cube that a word speaks of, bricks: of the empty cube, or of the brick at its level.
NPH_FN int wordEdge(uvec2 word) { return 1 << int(wordIsEmpty(word) ? word.y : (word.y >> 18u) & 7u); }

// First texel of the brick in the atlas, and texels along each axis.
NPH_FN ivec3 wordCorner(uvec2 word) {
  return ivec3(int(word.x & 4095u), int((word.x >> 12u) & 4095u), int(word.y & 4095u));
}
NPH_FN ivec3 wordSamples(uvec2 word) {
  return ivec3(9) - 4 * ivec3(int((word.y >> 12u) & 1u), int((word.y >> 13u) & 1u), int((word.y >> 14u) & 1u));
}

// A position in the brick from the first sample that is kept, in voxels. Beyond those that are kept the density is that of the
// outermost, which is 0, or at most a hair away.
NPH_FN vec3 keptPosition(uvec2 word, vec3 position) {
  vec3 first = 4.0f * vec3(float((word.y >> 15u) & 1u), float((word.y >> 16u) & 1u), float((word.y >> 17u) & 1u));
  return clamp(position - first, vec3(0.0f), vec3(wordSamples(word) - 1));
}

NPH_FN bool isOutside(ivec3 brick) {
  return brick.x < 0 || brick.y < 0 || brick.z < 0 || brick.x >= params.brickCount.x || brick.y >= params.brickCount.y ||
         brick.z >= params.brickCount.z;
}

// Index-space corner of the aligned cube of `edge` bricks around a brick.
NPH_FN vec3 cubeCorner(ivec3 brick, int edge) { return vec3(brick - (brick & ivec3(edge - 1))) * kBrickEdge; }

// A direction as wayOut takes it: what does not depend on where it is asked.
struct Course {
  vec3 inverse;  // 1 over the direction; 0 along axes that it hardly moves along
  vec3 ahead;    // 1 along axes where the far face is the upper one
  vec3 still;    // 1e9 where inverse is 0, else 0
};

NPH_FN Course courseOf(vec3 direction) {
  Course course;
  for (int axis = 0; axis < 3; ++axis) {
    bool moves = abs(direction[axis]) > 1e-9f;
    course.inverse[axis] = moves ? 1.0f / direction[axis] : 0.0f;
    course.ahead[axis] = direction[axis] > 0.0f ? 1.0f : 0.0f;
    course.still[axis] = moves ? 0.0f : 1e9f;
  }
  return course;
}

// Way along a direction from `position` to where it leaves the cube, in multiples of the direction.
NPH_FN float wayOut(vec3 position, Course course, vec3 corner, float size) {
  vec3 way = (corner + size * course.ahead - position) * course.inverse + course.still;
  return min(way.x, min(way.y, way.z));
}

// e^(−x) of each channel; NPH_GREY is true where it is known that all have one extinction.
NPH_FN vec3 lessened(vec3 x) { return NPH_GREY ? vec3(exp(-x.x)) : exp(-x); }

// A debug mode, where NPH_CHECK is 1: what was skipped is read after all, from an index that says of each brick alone where it
// lies (storedWord, as brickWord), and what was read is held against its brick's bound. cost.z counts the densities that
// were checked so, cost.w those of them that should have been 0, or less.
NPH_FN void checkDensity(vec3 position, NPH_INOUT(vec4) cost) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  if (isOutside(brick)) return;
  uvec2 word = storedWord(brick);
  int edge = wordEdge(word);
  float rho = wordIsEmpty(word) ? 0.0f : brickDensity(word, (position - cubeCorner(brick, edge)) / float(edge));
  cost.z += 1.0f;
  cost.w += rho > 0.0f ? 1.0f : 0.0f;
}

NPH_FN void checkSkipped(vec3 origin, vec3 direction, float from, float to, float step, NPH_INOUT(vec4) cost) {
  for (float t = from + 0.5f * step; NPH_CHECK == 1 && t < to; t += step) checkDensity(origin + t * direction, cost);
}

NPH_FN void checkBound(uvec2 word, float rho, NPH_INOUT(vec4) cost) {
  if (NPH_CHECK != 1) return;
  cost.z += 1.0f;
  // Mixing rounds.
  cost.w += rho > 1.00001f * wordMaximum(word) ? 1.0f : 0.0f;
}

// Density at an index-space position. Where it is empty there, `toExit` becomes the number of steps of the course's direction
// from there to the far
// face of the largest known empty cube, over which all densities are 0; otherwise it is 0.
NPH_FN float densityAndExit(vec3 position, Course course, NPH_OUT(float) toExit) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  toExit = 0.0f;
  // Rounding may place an end of the ray a hair outside the box, where the density is 0.
  if (isOutside(brick)) return 0.0f;
  uvec2 word = brickWord(brick);
  int edge = wordEdge(word);
  vec3 corner = cubeCorner(brick, edge);
  if (!wordIsEmpty(word)) return brickDensity(word, (position - corner) / float(edge));
  toExit = wayOut(position, course, corner, kBrickEdge * float(edge));
  return 0.0f;
}

// Edge of what counts as a voxel at a position, in voxels of the index: `least`, or the brick's voxel where that is longer.
// NPH_LEVELS is true where bricks are of several levels.
NPH_FN float voxelAt(vec3 position, float least) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  if (!NPH_LEVELS || isOutside(brick)) return least;
  uvec2 word = brickWord(brick);
  return wordIsEmpty(word) ? least : max(least, float(wordEdge(word)));
}

// ∫ ρ ds in world units from `origin` along `direction` (index units per world unit) over at most `reach` world units, by
// steps that grow with the way gone: what lies far from a point shades its neighbours alike. Empty bricks are passed without
// reading them, on the same steps. `steps` is the first one's length, voxels of the index, and the growth of each over the
// one before. Gives up, with what it has, once it exceeds `enough`.
NPH_FN float columnDensity(vec3 origin, vec3 direction, float reach, float enough, vec2 steps, float start,
                           NPH_INOUT(vec4) cost) {
  float tNear = 0.0f;
  float tFar = 0.0f;
  if (!intersectBox(origin, direction, vec3(params.boxMin), vec3(params.boxMax), tNear, tFar)) return 0.0f;
  tFar = min(tFar, reach);
  float dt = steps.x / length(direction);
  float growth = steps.y;
  Course course = courseOf(direction);
  float column = 0.0f;
  float t = tNear;
  // Kept apart from the loop's condition, which a compiler may take to be false behind the loop.
  float arrived = t < tFar ? 0.0f : 1.0f;
  while (t < tFar) {               // false also where t is NaN
    float ds = min(dt, tFar - t);  // the last step ends where the medium does
    float middle = t + start * ds;
    float toExit = 0.0f;
    column += densityAndExit(origin + middle * direction, course, toExit) * ds;
    cost.x += 1.0f;
    arrived = column > enough ? 1.0f : 0.0f;
    if (column > enough) break;
    t += ds;
    dt *= growth;
    // Steps whose reading lies in the same empty cube, a thousandth of a step before its end at most.
    float end = min(middle + toExit, tFar) - 1e-3f * dt;
    while (t + start * dt < end) {
      if (NPH_CHECK == 1) checkDensity(origin + (t + start * dt) * direction, cost);
      t += dt;
      dt *= growth;
    }
    arrived = t < tFar ? 0.0f : 1.0f;
  }
  cost.y = max(cost.y, 1.0f - arrived);
  return column;
}
