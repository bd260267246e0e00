// Entry points of the rebuild's first stage: each particle's mass in whole units, added to the voxels that its kernel reaches.
// NPH_WIDE 0: one particle an invocation, wide ones put on a list; 1: one plane of one of those an invocation.
#version 450 core
#include "dialect.glsl"
#include "shared/math.glsl"
#include "shared/random.glsl"
#include "shared/noise.glsl"
#include "shared/particles_parameters.glsl"
#include "live_particles.glsl"
#include "shared/particles.glsl"
#include "shared/splat.glsl"
#include "live_grid.glsl"

layout(local_size_x = 32) in;
layout(std430, binding = 2) buffer Sums { uint sums[]; };  // x fastest
layout(std430, binding = 3) buffer Wide {
  uvec4 wideGroups;  // as an indirect dispatch reads them; w: how many are listed
  uint wide[];
};

// Voxels that one invocation visits, twice: some drivers end loops after 65535 turns.
const int kMostVisited = 4096;
const uint kMostGroups = 65535u;

// A particle among the voxels.
struct Footprint {
  vec3 centre;  // voxels from the grid's first
  float radius;
  vec3 stretch;
  ivec3 low, high;  // voxels that it can reach, both included
  float units;      // of its mass
};

bool footprintOf(LiveParticle p, out Footprint f) {
  float share = p.place.w / p.motion.w;
  f.radius = p.born.x * curveAt(particles.sizeCurve, particles.flags.y, share) * gridCorner.w;
  f.units = p.born.y * curveAt(particles.densityCurve, particles.flags.z, share) * gridUnits.x;
  f.centre = (p.place.xyz - gridCorner.xyz) * gridCorner.w;
  f.stretch = vec3(0.0);
  if (NPH_STRETCHED) f.stretch = seenVelocity(p.place.xyz, p.motion.xyz, gridUnits.w) * gridUnits.z;
  bool stretched = dot(f.stretch, f.stretch) > 0.0;
  vec3 reach = (stretched ? max(f.radius, 1.0) : f.radius) + 0.5 * abs(f.stretch);
  vec3 room = vec3(gridSize.xyz) + 1.0 + reach;
  // What cannot reach the grid, or is no number.
  if (!all(lessThan(abs(f.centre), room + vec3(gridSize.xyz))) || !(f.units > 0.0)) return false;
  vec3 cell = floor(f.centre);
  vec3 rest = f.centre - cell;
  bool point = f.radius <= 1.0 && !stretched;
  f.low = ivec3(cell) + (point ? ivec3(0) : -ivec3(floor(reach - rest)));
  f.high = ivec3(cell) + (point ? ivec3(1) : ivec3(floor(reach + rest)));
  return all(greaterThanEqual(f.high, ivec3(0))) && all(lessThan(f.low, gridSize.xyz));
}

float weightAt(Footprint f, ivec3 voxel) {
  vec3 apart = vec3(voxel) - f.centre;
  return NPH_STRETCHED ? splatStretched(NPH_KERNEL, apart, f.radius, f.stretch) : splatWeight(NPH_KERNEL, apart, f.radius);
}

#if NPH_WIDE
// The Gaussian that is not stretched is a product of sums along the axes.
float wideSum(Footprint f) {
  if (NPH_KERNEL != kSplatGaussian || dot(f.stretch, f.stretch) > 0.0)
    return splatWideSum(NPH_KERNEL, max(f.radius, 1.0), f.stretch);
  vec3 along = vec3(0.0);
  ivec3 count = f.high - f.low;
  for (int n = 0; n <= max(count.x, max(count.y, count.z)); ++n) {
    vec3 apart = (vec3(f.low + n) - f.centre) / f.radius;
    for (int axis = 0; axis < 3; ++axis) along[axis] += splatKernel(kSplatGaussian, apart[axis] * apart[axis]);
  }
  return along.x * along.y * along.z;
}

void main() {
  int z = int(gl_GlobalInvocationID.x);
  for (uint n = gl_WorkGroupID.y; n < wideGroups.w; n += gl_NumWorkGroups.y) {
    Footprint f;
    if (!footprintOf(slots[wide[n]], f) || z >= gridSize.z || z < f.low.z || z > f.high.z) continue;
    float scale = f.units / wideSum(f);
    ivec3 low = max(f.low, ivec3(0));
    ivec3 high = min(f.high, gridSize.xyz - 1);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        uint share = uint(weightAt(f, ivec3(x, y, z)) * scale + 0.5);
        if (share > 0u) atomicAdd(sums[(z * gridSize.y + y) * gridSize.x + x], share);
      }
    }
  }
}
#else
// Shares are rounded so that they add up to the particle's mass: each is the difference of two rounded running sums.
void addShares(Footprint f, float sum) {
  float scale = f.units / sum;
  float running = 0.0;
  uint given = 0u;
  for (int z = f.low.z; z <= f.high.z; ++z) {
    for (int y = f.low.y; y <= f.high.y; ++y) {
      int row = (z * gridSize.y + y) * gridSize.x;
      bool inside = z >= 0 && z < gridSize.z && y >= 0 && y < gridSize.y;
      for (int x = f.low.x; x <= f.high.x; ++x) {
        running += weightAt(f, ivec3(x, y, z)) * scale;
        uint until = uint(running + 0.5);
        if (until != given && inside && x >= 0 && x < gridSize.x) atomicAdd(sums[row + x], until - given);
        given = until;
      }
    }
  }
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= uint(stepCounts.y)) return;
  LiveParticle p = slots[slot];
  if (!isAlive(p)) return;
  atomicAdd(alive, 1u);
  Footprint f;
  if (!footprintOf(p, f)) return;
  vec3 edges = vec3(f.high - f.low + 1);
  if (edges.x * edges.y * edges.z > float(kMostVisited)) {
    uint n = atomicAdd(wideGroups.w, 1u);
    wide[n] = slot;
    atomicMax(wideGroups.y, min(n + 1u, kMostGroups));
    return;
  }
  float sum = 0.0;
  for (int z = f.low.z; z <= f.high.z; ++z)
    for (int y = f.low.y; y <= f.high.y; ++y)
      for (int x = f.low.x; x <= f.high.x; ++x) sum += weightAt(f, ivec3(x, y, z));
  addShares(f, sum);
}
#endif
