// Entry points of the neighbours' stages, which put particles into cells as wide as the reach, hashed into buckets: counting,
// room for each bucket, filling, sums. Buckets lie in no order and neither do particles in them; the sums are of whole numbers,
// which no order changes.
#version 450 core
#include "dialect.glsl"
#include "shared/math.glsl"
#include "shared/random.glsl"
#include "shared/noise.glsl"
#include "shared/particles_parameters.glsl"
#include "live_particles.glsl"
#include "shared/particles.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 2) buffer Neighbours { NeighbourSums neighbours[]; };
layout(std430, binding = 3) buffer Buckets { uvec4 buckets[]; };  // particles, first entry, entries filled; the last: all entries
layout(std430, binding = 4) buffer Entries { uint entries[]; };

// Turns of a loop are counted by some drivers, 65535 of them at most.
const uint kMostLooked = 60000u;

ivec3 cellOf(vec3 place) { return ivec3(floor(place / particles.neighbours.x)); }

uint bucketOf(ivec3 cell) {
  // Three large primes [Teschner 2003].
  uint h = (uint(cell.x) * 73856093u) ^ (uint(cell.y) * 19349663u) ^ (uint(cell.z) * 83492791u);
  h ^= h >> 15u;
  return h % uint(buckets.length() - 1);
}

void addBucket(uint slot, vec3 place, ivec3 cell, inout NeighbourSums sums) {
  uvec4 bucket = buckets[bucketOf(cell)];
  for (uint n = 0u; n < bucket.x; ++n) {
    uint other = entries[bucket.y + n];
    vec3 there = slots[other].place.xyz;
    if (other != slot && cellOf(there) == cell) addNeighbour(there - place, sums);
  }
}

void sumNeighbours(uint slot) {
  vec3 place = slots[slot].place.xyz;
  ivec3 own = cellOf(place);
  uint looked = 0u;
  for (int n = 0; n < 27; ++n) looked += buckets[bucketOf(own + ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1))].x;
  NeighbourSums sums = NeighbourSums(ivec4(0), ivec4(0));
  if (looked > kMostLooked) {
    atomicAdd(crowded, 1u);
  } else {
    for (int n = 0; n < 27; ++n) addBucket(slot, place, own + ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), sums);
  }
  neighbours[slot] = sums;
}

void main() {
  uint n = gl_GlobalInvocationID.x;
#if NPH_STAGE == 1
  uint last = uint(buckets.length() - 1);
  if (n < last && buckets[n].x > 0u) buckets[n].y = atomicAdd(buckets[last].x, buckets[n].x);
#else
  if (n >= uint(stepCounts.y) || !isAlive(slots[n])) return;
#if NPH_STAGE == 0
  atomicAdd(buckets[bucketOf(cellOf(slots[n].place.xyz))].x, 1u);
#elif NPH_STAGE == 2
  uint bucket = bucketOf(cellOf(slots[n].place.xyz));
  entries[buckets[bucket].y + atomicAdd(buckets[bucket].z, 1u)] = n;
#else
  sumNeighbours(n);
#endif
#endif
}
