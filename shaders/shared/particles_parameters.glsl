// What moves particles, in rows of 16 bytes: std140 on the GPU, memcpy on the CPU. World units and seconds.

NPH_CONST int kMaxVortices = 8;
NPH_CONST int kMaxAttractors = 8;
NPH_CONST int kMaxCurvePoints = 8;

NPH_CONST int kEmitPoint = 0;   // all at the centre
NPH_CONST int kEmitSphere = 1;
NPH_CONST int kEmitBox = 2;
NPH_CONST int kEmitDisc = 3;    // flat, round the axis
NPH_CONST int kEmitSites = 4;   // places that somebody else chose: of a mesh or of a file of points

struct EmitterParameters {
  vec4 center;       // w: how much of the radius is left to chance, 0…1
  vec4 size;         // sphere and disc: radius in x; box: half sizes. w: density
  vec4 axis;         // of the disc, length 1. w: how much of the density is left to chance
  vec4 velocity;     // w: temperature
  vec4 motion;       // x: speed along the outward normal. y: largest random velocity. z: life, w: how much of it is chance
  vec4 born;         // x: radius of a particle
  ivec4 kind;        // x: one of kEmit…; y: 1 where it emits from its surface; z: seed
};

struct VortexParameters {
  vec4 center;  // w: turns at the centre, radians per second
  vec4 axis;    // length 1. w: distance at which the rate has fallen to 1/e
};

struct AttractorParameters {
  vec4 center;  // w: acceleration per world unit of distance, near the centre; negative pushes away
  vec4 reach;   // x: distance at which that has fallen to a quarter
};

struct ParticleParameters {
  vec4 gravity;     // acceleration. w: drag, 1/s
  vec4 wind;        // the velocity that drag pulls to. w: cooling, 1/s
  vec4 up;          // length 1. w: buoyancy, acceleration along up per unit of temperature
  vec4 curl;        // x: root mean square speed of the first octave; y: cells per world unit; z: gain of octaves
  vec4 curlScroll;  // cells per second
  vec4 ground;      // x: height along up; y: share of the speed kept in a bounce; z: share of the sliding speed lost
  vec4 neighbours;  // x: reach; y: cohesion, 1/s²; z: separation, acceleration
  ivec4 counts;     // x: vortices; y: attractors; z: octaves of the curl noise; w: its seed
  ivec4 flags;      // x: 1 where there is a ground; y: points of the size curve; z: of the density curve
  vec4 sizeCurve[kMaxCurvePoints];     // x: share of the life, growing; y: factor of the radius
  vec4 densityCurve[kMaxCurvePoints];  // the same for the mass
  VortexParameters vortices[kMaxVortices];
  AttractorParameters attractors[kMaxAttractors];
};
