// Looks inside, in place of the lit picture: a slice of the density (NPH_VIEW 1), or how much of each ray's way through the
// box lies in empty bricks and is passed without reading (NPH_VIEW 2). Included by march.frag, after the shared texts.
// Writes the value times its weight into radiance.r, and the weight into alpha: 1 where the ray meets what is shown.

layout(location = 3) uniform vec2 slice;  // axis, place in voxels from the brick grid's corner

// Distance along `direction` to the far side of the brick that holds `position`; at least a thousandth of a voxel's way, so
// that a walk goes on.
float brickExit(vec3 position, vec3 direction) {
  vec3 corner = floor(position / kBrickEdge) * kBrickEdge;
  float toExit = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(direction[axis]) > 1e-9) {
      float face = direction[axis] > 0.0 ? corner[axis] + kBrickEdge : corner[axis];
      toExit = min(toExit, (face - position[axis]) / direction[axis]);
    }
  }
  return max(toExit, 1e-3 / length(direction));
}

bool holdsDensity(vec3 position) {
  ivec3 brick = ivec3(floor(position / kBrickEdge));
  if (any(lessThan(brick, ivec3(0))) || any(greaterThanEqual(brick, params.brickCount.xyz))) return false;
  return !wordIsEmpty(brickWord(brick));
}

// x: value. y: 1 where there is one.
vec2 densityOnSlice(vec3 origin, vec3 direction, float tNear, float tFar) {
  int axis = int(slice.x);
  if (abs(direction[axis]) < 1e-9) return vec2(0.0);
  float t = (slice.y - origin[axis]) / direction[axis];
  if (!(t >= tNear && t <= tFar)) return vec2(0.0);
  float toExit = 0.0;
  return vec2(densityAndExit(origin + t * direction, courseOf(direction), toExit), 1.0);
}

vec2 skippedShare(vec3 origin, vec3 direction, float tNear, float tFar) {
  if (!(tFar > tNear)) return vec2(0.0);
  float skipped = 0.0;
  float t = tNear;
  while (t < tFar) {
    vec3 position = origin + t * direction;
    float ds = min(brickExit(position, direction), tFar - t);
    // Half-way through: on a face the brick would be in doubt.
    if (!holdsDensity(position + 0.5 * ds * direction)) skipped += ds;
    t += max(ds, 1e-6 * tFar);
  }
  return vec2(skipped / (tFar - tNear), 1.0);
}

void main() {
  vec2 at = floor(gl_FragCoord.xy) + subPixel;
  vec3 origin = params.originCorner.xyz + at.x * params.originDx.xyz + at.y * params.originDy.xyz;
  vec3 direction = params.directionCorner.xyz + at.x * params.directionDx.xyz + at.y * params.directionDy.xyz;
  float tNear = 0.0;
  float tFar = 0.0;
  vec2 found = vec2(0.0);
  if (intersectBox(origin, direction, params.boxMin.xyz, params.boxMax.xyz, tNear, tFar)) {
#if NPH_VIEW == 1
    found = densityOnSlice(origin, direction, tNear, tFar);
#else
    found = skippedShare(origin, direction, tNear, tFar);
#endif
  }
  outRadiance = vec4(found.x * found.y, 0.0, 0.0, found.y);
  outTransmittance = vec4(vec3(1.0 - found.y), 1.0);
  outDepth = vec4(0.0);
}
