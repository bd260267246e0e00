// Entry point of the stage `move`: one step of each particle, and births into the slots whose turn it is.
#version 450 core
#include "dialect.glsl"
#include "shared/math.glsl"
#include "shared/random.glsl"
#include "shared/noise.glsl"
#include "shared/particles_parameters.glsl"
#include "live_particles.glsl"
#include "shared/particles.glsl"

layout(local_size_x = 64) in;
#if NPH_NEIGHBOURS
layout(std430, binding = 2) readonly buffer Neighbours { NeighbourSums neighbours[]; };
#endif

NeighbourSums noNeighbours() { return NeighbourSums(ivec4(0), ivec4(0)); }

// Whether the slot's turn is in this step, and the number of the birth that takes it.
bool isBornNow(uvec4 ring, uint slot, out uint number) {
  number = 0u;
  uint at = slot - ring.x;
  if (ring.w == 0u || ring.w - 1u < at) return false;
  uint last = ring.w - 1u;
  number = last - (last - at) % ring.y;
  return number >= ring.z;
}

LiveParticle bornParticle(int e, uint number) {
  uvec4 ring = emitters[e].ring;
  // Births are spread over the step, so that a jet has no gaps.
  float share = (float(number - ring.z) + 0.5) / float(ring.w - ring.z);
  float rest = stepCounts.z != 0 ? 0.0 : stepTimes.y * (1.0 - share);
  Particle p = emitParticle(emitters[e].emitter, (uint(e) << 28u) | number, vec3(0.0), vec3(0.0));
  if (rest > 0.0)
    moveParticle(p.position, p.velocity, 0.0, p.temperature, noNeighbours(), stepTimes.z - rest, rest);
  return LiveParticle(vec4(p.position, rest), vec4(p.velocity, p.life), vec4(p.radius, p.mass, p.temperature, 0.0));
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= uint(stepCounts.y)) return;
  int e = 0;
  while (e + 1 < stepCounts.x && slot >= emitters[e + 1].ring.x) ++e;
  uint number;
  LiveParticle p = slots[slot];
  if (isBornNow(emitters[e].ring, slot, number)) {
    p = bornParticle(e, number);
  } else {
    if (!isAlive(p)) return;
    vec3 position = p.place.xyz;
    vec3 velocity = p.motion.xyz;
    NeighbourSums sums = noNeighbours();
#if NPH_NEIGHBOURS
    sums = neighbours[slot];
#endif
    moveParticle(position, velocity, p.place.w, p.born.z, sums, stepTimes.x, stepTimes.y);
    p.place = vec4(position, p.place.w + stepTimes.y);
    p.motion.xyz = velocity;
  }
  // False for what is not a number, too.
  bool near = all(lessThanEqual(abs(p.place.xyz), vec3(stepTimes.w))) && dot(p.motion.xyz, p.motion.xyz) < 1e37;
  if (!near) {
    atomicAdd(runaways, 1u);
    p.place = vec4(0.0);
    p.motion = vec4(0.0);
  }
  slots[slot] = p;
}
