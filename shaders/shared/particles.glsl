// Birth and motion of particles, one at a time: the same text moves them in the bake and live. Included after math, random, noise
// and particles_parameters; what it calls `particles` is a uniform block in GLSL and a member in C++.

// The root mean square length of the curl of three gradient noises, per cell.
NPH_CONST float kCurlRms = 1.676f;
// Neighbour sums are kept in whole numbers of this part of the reach, so that the order of neighbours does not matter.
NPH_CONST float kNeighbourUnit = 16384.0f;

struct Particle {
  vec3 position;
  vec3 velocity;  // its own; flows carry it beside that
  float age;
  float life;
  float radius;       // at birth
  float mass;         // at birth: density · 4/3 π radius³
  float temperature;  // at birth
};

// What the neighbours of a particle amount to, in units of 1/kNeighbourUnit.
struct NeighbourSums {
  ivec4 towards;  // Σ w (x_j − x_i)/reach; w: Σ w
  ivec4 apart;    // Σ w (x_i − x_j)/|x_i − x_j|
};

// Number `k` of the random numbers of particle `id`, in [0, 1).
NPH_FN float particleUniform(uint seed, uint id, uint k) {
  uint state = randomState(id, k, 0x70617274u, seed);  // "part": apart from all other uses of the hash
  return nextUniform(state);
}

// A direction, evenly over the sphere, from two numbers in [0, 1).
NPH_FN vec3 directionFrom(float u, float v) {
  float z = 1.0f - 2.0f * u;
  float r = sqrt(max(0.0f, 1.0f - z * z));
  vec2 turn = sineCosine(6.28318531f * v);
  return vec3(r * turn.y, r * turn.x, z);
}

// A place evenly in the unit ball: the largest of three numbers is distributed as the cube root of one.
NPH_FN vec3 placeInBall(uint seed, uint id, uint k) {
  vec3 direction = directionFrom(particleUniform(seed, id, k), particleUniform(seed, id, k + 1u));
  float a = particleUniform(seed, id, k + 2u);
  float b = particleUniform(seed, id, k + 3u);
  float c = particleUniform(seed, id, k + 4u);
  return direction * max(a, max(b, c));
}

// A place on a box's surface, evenly, in half sizes; and its normal.
NPH_FN vec3 placeOnBox(vec3 halfSize, uint seed, uint id, NPH_OUT(vec3) normal) {
  vec3 face = vec3(halfSize.y * halfSize.z, halfSize.z * halfSize.x, halfSize.x * halfSize.y);
  float at = particleUniform(seed, id, 3u) * (face.x + face.y + face.z);
  vec3 place = vec3(2.0f * particleUniform(seed, id, 0u) - 1.0f, 2.0f * particleUniform(seed, id, 1u) - 1.0f,
                    2.0f * particleUniform(seed, id, 2u) - 1.0f);
  int axis = at < face.x ? 0 : (at < face.x + face.y ? 1 : 2);
  float side = place[axis] < 0.0f ? -1.0f : 1.0f;
  normal = vec3(0.0f);
  normal[axis] = side;
  place[axis] = side;
  return place * halfSize;
}

// The particle `id` of an emitter as it is born. `site` and `siteNormal` are read where the emitter's places come from elsewhere.
NPH_FN Particle emitParticle(EmitterParameters emitter, uint id, vec3 site, vec3 siteNormal) {
  uint seed = uint(emitter.kind.z);
  bool surface = emitter.kind.y != 0;
  vec3 normal = vec3(0.0f);
  vec3 place = vec3(0.0f);
  if (emitter.kind.x == kEmitSphere) {
    vec3 ball = placeInBall(seed, id, 0u);
    float far = length(ball);
    normal = far > 0.0f ? ball / far : vec3(particles.up);
    place = (surface ? normal : ball) * emitter.size.x;
  } else if (emitter.kind.x == kEmitBox) {
    place = placeOnBox(vec3(emitter.size), seed, id, normal);
    if (!surface)
      place = vec3(emitter.size) * vec3(2.0f * particleUniform(seed, id, 0u) - 1.0f, 2.0f * particleUniform(seed, id, 1u) - 1.0f,
                                        2.0f * particleUniform(seed, id, 2u) - 1.0f);
  } else if (emitter.kind.x == kEmitDisc) {
    normal = vec3(emitter.axis);
    vec3 aside = abs(normal.x) < 0.5f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
    vec3 u = normalize(cross(normal, aside));
    vec3 v = cross(normal, u);
    vec2 turn = sineCosine(6.28318531f * particleUniform(seed, id, 0u));
    float far = surface ? 1.0f : sqrt(particleUniform(seed, id, 1u));
    place = (u * turn.y + v * turn.x) * (far * emitter.size.x);
  } else if (emitter.kind.x == kEmitSites) {
    place = site;
    normal = siteNormal;
  }
  Particle born;
  born.position = vec3(emitter.center) + place;
  born.velocity = vec3(emitter.velocity) + normal * emitter.motion.x + placeInBall(seed, id, 5u) * emitter.motion.y;
  born.age = 0.0f;
  born.life = emitter.motion.z * (1.0f - emitter.motion.w * particleUniform(seed, id, 10u));
  born.radius = emitter.born.x * (1.0f - emitter.center.w * particleUniform(seed, id, 11u));
  float density = emitter.size.w * (1.0f - emitter.axis.w * particleUniform(seed, id, 12u));
  born.mass = density * 4.18879020f * born.radius * born.radius * born.radius;  // 4/3 π
  born.temperature = emitter.velocity.w;
  return born;
}

// A piecewise linear curve of `count` points, constant beyond its ends.
NPH_FN float curveAt(vec4 curve[kMaxCurvePoints], int count, float x) {
  if (count == 0) return 1.0f;
  if (x <= curve[0].x) return curve[0].y;
  for (int n = 1; n < count; ++n) {
    if (x < curve[n].x)
      return curve[n - 1].y + (curve[n].y - curve[n - 1].y) * ((x - curve[n - 1].x) / (curve[n].x - curve[n - 1].x));
  }
  return curve[count - 1].y;
}

NPH_FN float temperatureAt(float birthTemperature, float age) {
  return particles.wind.w > 0.0f ? birthTemperature * exponential(-particles.wind.w * age) : birthTemperature;
}

// A flow without sources: the curl of three gradient noises, octave on octave [Bridson 2007].
NPH_FN vec3 curlVelocity(vec3 position, float time) {
  vec3 flow = vec3(0.0f);
  float speed = particles.curl.x / kCurlRms;
  vec3 p = position * particles.curl.y + vec3(particles.curlScroll) * time;
  for (int octave = 0; octave < particles.counts.z; ++octave) {
    vec3 whole = floor(p);
    ivec3 cell = ivec3(whole);
    uint seed = seedApart(uint(particles.counts.w), octave);
    vec3 sx = perlinSlope(cell, p - whole, 0, seed);
    vec3 sy = perlinSlope(cell, p - whole, 0, seed + 1u);
    vec3 sz = perlinSlope(cell, p - whole, 0, seed + 2u);
    flow += speed * vec3(sz.y - sy.z, sx.z - sz.x, sy.x - sx.y);
    speed *= particles.curl.z;
    p = p * 2.0f;
  }
  return flow;
}

// Radians per second round the vortex's axis, at a squared distance from it.
NPH_FN float vortexRate(VortexParameters vortex, float squared) {
  return vortex.center.w * exponential(-squared / (vortex.axis.w * vortex.axis.w));
}

// The velocity at which a particle is seen to move: its own, and that of the flows that carry it.
NPH_FN vec3 seenVelocity(vec3 position, vec3 velocity, float time) {
  vec3 seen = velocity;
  if (particles.counts.z > 0) seen += curlVelocity(position, time);
  for (int n = 0; n < particles.counts.x; ++n) {
    vec3 axis = vec3(particles.vortices[n].axis);
    vec3 arm = position - vec3(particles.vortices[n].center);
    arm -= axis * dot(arm, axis);
    seen += cross(axis, arm) * vortexRate(particles.vortices[n], dot(arm, arm));
  }
  return seen;
}

// Turns a place round each vortex in its turn, by the angle of a whole step: no step is too long to stay on its circle.
NPH_FN vec3 carriedByVortices(vec3 position, float dt) {
  vec3 place = position;
  for (int n = 0; n < particles.counts.x; ++n) {
    vec3 axis = vec3(particles.vortices[n].axis);
    vec3 centre = vec3(particles.vortices[n].center);
    vec3 apart = place - centre;
    vec3 along = axis * dot(apart, axis);
    vec3 arm = apart - along;
    vec2 turn = sineCosine(vortexRate(particles.vortices[n], dot(arm, arm)) * dt);
    place = centre + along + arm * turn.y + cross(axis, arm) * turn.x;
  }
  return place;
}

// Adds neighbour j, which lies `apart` = x_j − x_i away, to the sums of i; nothing beyond the reach.
NPH_FN void addNeighbour(vec3 apart, NPH_INOUT(NeighbourSums) sums) {
  float reach = particles.neighbours.x;
  float squared = dot(apart, apart);
  if (squared >= reach * reach) return;
  float distance = sqrt(squared);
  float weight = 1.0f - distance / reach;
  vec3 towards = apart * (weight / reach);
  vec3 away = distance > 0.0f ? apart * (-weight / distance) : vec3(0.0f);
  sums.towards += ivec4(floor(vec4(towards, weight) * kNeighbourUnit + vec4(0.5f)));
  sums.apart += ivec4(ivec3(floor(away * kNeighbourUnit + vec3(0.5f))), 0);
}

// Velocity after a kick by springs of stiffness K that pull with acceleration `pull`: v' = v + dt (pull − K dt v'), one implicit
// step, which shrinks where an explicit one would grow without end.
NPH_FN vec3 afterSpring(vec3 velocity, vec3 pull, float stiffness, float dt) {
  return (velocity + pull * dt) / (1.0f + dt * dt * stiffness);
}

NPH_FN vec3 afterNeighbours(vec3 velocity, NeighbourSums sums, float dt) {
  if (sums.towards.w == 0) return velocity;
  float weight = float(sums.towards.w);
  // The mean place of the neighbourhood, the particle itself in it: so two that pull at each other do not overshoot.
  vec3 centre = vec3(ivec3(sums.towards)) / (weight + kNeighbourUnit) * particles.neighbours.x;
  vec3 push = vec3(ivec3(sums.apart)) / max(kNeighbourUnit, weight);
  return afterSpring(velocity, centre * particles.neighbours.y + push * particles.neighbours.z,
                     particles.neighbours.y + particles.neighbours.z / particles.neighbours.x, dt);
}

NPH_FN vec3 afterAttractors(vec3 position, vec3 velocity, float dt) {
  vec3 v = velocity;
  for (int n = 0; n < particles.counts.y; ++n) {
    vec3 apart = vec3(particles.attractors[n].center) - position;
    float reach = particles.attractors[n].reach.x;
    float fall = 1.0f + dot(apart, apart) / (reach * reach);
    float stiffness = particles.attractors[n].center.w / (fall * fall);
    v = afterSpring(v, apart * stiffness, max(stiffness, 0.0f), dt);
  }
  return v;
}

// (e^(−z), φ1, φ2) for z ≥ 0: φ1 = (1 − e^(−z))/z, φ2 = (1 − φ1)/z; their series below ½, where differences would lose digits.
NPH_FN vec3 dragFactors(float z) {
  if (z > 0.5f) {
    float decay = exponential(-z);
    float first = (1.0f - decay) / z;
    return vec3(decay, first, (1.0f - first) / z);
  }
  // Σ (−z)^n/(n + 2)!, cut where the rest is below 1e-8.
  float second = 1.0f / 5040.0f - z * (1.0f / 40320.0f);
  second = 1.0f / 720.0f - z * second;
  second = 1.0f / 120.0f - z * second;
  second = 1.0f / 24.0f - z * second;
  second = 1.0f / 6.0f - z * second;
  second = 0.5f - z * second;
  float first = 1.0f - z * second;
  return vec3(1.0f - z * first, first, second);
}

// A particle below the ground comes back up, slower.
NPH_FN void meetGround(NPH_INOUT(vec3) position, NPH_INOUT(vec3) velocity) {
  vec3 up = vec3(particles.up);
  float below = particles.ground.x - dot(position, up);
  if (below <= 0.0f) return;
  float speed = dot(velocity, up);
  vec3 sliding = velocity - up * speed;
  position += up * (below * (1.0f + particles.ground.y));
  velocity = sliding * (1.0f - particles.ground.z) + up * (speed < 0.0f ? -particles.ground.y * speed : speed);
}

// One step from `time` on. Constant forces and drag are integrated exactly [exponential integrator], springs implicitly, vortices
// as rotations: no step makes them grow.
NPH_FN void moveParticle(NPH_INOUT(vec3) position, NPH_INOUT(vec3) velocity, float age, float birthTemperature,
                         NeighbourSums sums, float time, float dt) {
  vec3 up = vec3(particles.up);
  vec3 wind = vec3(particles.wind);
  vec3 acceleration = vec3(particles.gravity);
  if (particles.up.w != 0.0f) acceleration += up * (particles.up.w * temperatureAt(birthTemperature, age + 0.5f * dt));
  vec3 kicked = afterAttractors(position, afterNeighbours(velocity, sums, dt), dt);
  vec3 drag = dragFactors(particles.gravity.w * dt);
  vec3 drift = wind * dt + (kicked - wind) * (dt * drag.y) + acceleration * (dt * dt * drag.z);
  velocity = wind + (kicked - wind) * drag.x + acceleration * (dt * drag.y);
  if (particles.counts.z > 0) drift += curlVelocity(position + 0.5f * drift, time + 0.5f * dt) * dt;
  position = carriedByVortices(position + drift, dt);
  if (particles.flags.x != 0) meetGround(position, velocity);
}
