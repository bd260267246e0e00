// What the stages of live particles share: the slots that particles live in, and what moves them. Included after
// particles_parameters.

// A particle, at rest in its slot from birth to death. A slot whose age has reached its life is free.
struct LiveParticle {
  vec4 place;   // w: age
  vec4 motion;  // its own velocity; w: life
  vec4 born;    // radius, mass and temperature at birth; 0
};

// An emitter and the ring of slots that its particles take in turn.
struct LiveEmitter {
  EmitterParameters emitter;
  uvec4 ring;  // first slot, slots, births before this step, births after it
};

const int kMostEmitters = 16;

layout(std430, binding = 0) buffer Slots { LiveParticle slots[]; };
// Counted up by the stages, looked at now and then: particles alive, particles that left the range, neighbours too many.
layout(std430, binding = 1) buffer Status { uint alive; uint runaways; uint crowded; uint unusedStatus; };
layout(std140, binding = 1) uniform ParticleBlock { ParticleParameters particles; };
layout(std140, binding = 2) uniform StepBlock {
  LiveEmitter emitters[kMostEmitters];
  ivec4 stepCounts;  // emitters, slots, 1 for the births at time 0
  vec4 stepTimes;    // time before the step, its length, time after it; places are kept within w
};

bool isAlive(LiveParticle p) { return p.place.w < p.motion.w; }
