// A particle system as a recipe describes it: emitters, forces, ages, and how particles become a grid; YAML
// both ways. Depends on base and shaders/shared. Lengths in world units, times in seconds.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "base/yaml.h"
#include "particles/shared_text.h"

namespace nephele {

/// Points (x, y) with x growing; linear between, constant beyond the ends.
using ParticleCurve = std::vector<std::array<double, 2>>;

enum class EmitterShape { point, sphere, box, disc, mesh, points };

/// Where, when and as what particles are born.
struct Emitter {
  EmitterShape shape = EmitterShape::sphere;
  glm::dvec3 center{0.0};
  double radius = 0.5;       // of sphere and disc
  glm::dvec3 halfSize{0.5};  // of the box
  glm::dvec3 axis{0, 0, 1};  // of the disc; any length but 0
  std::string file;          // of mesh (OBJ, PLY) and points (CSV, PLY, VDB), as the recipe names it
  double scale = 1.0;        // world units for one unit of the file
  bool surface = false;      // emit from the surface alone
  ParticleCurve rate;        // particles per second over time
  ParticleCurve bursts;      // (time, count)
  glm::dvec3 velocity{0.0};
  double outward = 0.0;  // speed along the surface's normal
  double spread = 0.0;   // largest random velocity
  double particleRadius = 0.1;
  double radiusVariation = 0.0;  // 0…1: the smallest is (1 − this) of the largest
  double density = 1.0;          // mean over the ball of the particle's radius
  double densityVariation = 0.0;
  double life = 4.0;
  double lifeVariation = 0.0;
  double temperature = 0.0;
  int64_t seed = 0;
};

struct Vortex {
  glm::dvec3 center{0.0};
  glm::dvec3 axis{0, 0, 1};
  double rate = 1.0;    // radians per second on the axis
  double radius = 1.0;  // where the rate has fallen to 1/e
};

struct Attractor {
  glm::dvec3 center{0.0};
  double strength = 1.0;  // acceleration per world unit of distance near the centre; negative pushes away
  double radius = 1.0;    // where that has fallen to a quarter
};

struct Forces {
  glm::dvec3 gravity{0.0};
  glm::dvec3 wind{0.0};
  double drag = 0.0;      // 1/s
  double buoyancy = 0.0;  // acceleration along up per unit of temperature
  double cooling = 0.0;   // 1/s
  double curlSpeed = 0.0;
  double curlCellSize = 1.0;
  int64_t curlOctaves = 1;
  double curlGain = 0.5;
  glm::dvec3 curlScroll{0.0};  // cells per second
  int64_t curlSeed = 0;
  double neighbourReach = 0.0;  // 0: particles do not see each other
  double cohesion = 0.0;
  double separation = 0.0;
  bool ground = false;
  double groundHeight = 0.0;
  double bounce = 0.2;
  double friction = 0.1;
  std::vector<Vortex> vortices;
  std::vector<Attractor> attractors;
};

enum class SplatKernel { gaussian, wendland, smoothSphere };

struct ParticleSystem {
  std::vector<Emitter> emitters;
  Forces forces;
  ParticleCurve sizeOverLife;     // share of the life → factor of the radius
  ParticleCurve densityOverLife;  // share of the life → factor of the mass
  int64_t substeps = 2;           // steps a frame
  int64_t prewarm = 0;            // frames that are simulated before frame 0
  SplatKernel kernel = SplatKernel::wendland;
  double shutter = 0.0;            // frames over which a particle is stretched along its velocity
  double erosion = 0.0;            // how deep noise eats into a particle, in its radii per unit of the field
  yaml::NodePtr erosionField;      // a density field; whoever knows fields reads it
  std::vector<std::string> grids;  // beside density: vel, temperature, age
  std::vector<std::string> writePoints;  // beside each frame: csv, ply, vdb
  double massTolerance = 1.0;            // largest share of the mass that a grid may lose
  glm::dvec3 boxMin{0.0}, boxMax{0.0};   // every frame's active box; none where equal
  bool stableBox = false;                // every frame's active box is that of all frames
  int64_t checkpointEvery = 24;          // frames; 0: none

  bool hasBox() const { return boxMin != boxMax; }
};

/// Reads the map under `particles:`. Adds every error it finds to `out`; the result is usable only where none
/// was added. Files are not opened.
ParticleSystem readParticles(const yaml::Node& node, Diagnostics& out);

/// The system as YAML that readParticles() reads back to the same values; keys that stand at their defaults
/// are left out.
std::string writeParticles(const ParticleSystem& system);

/// The forces as the shared text takes them. `upAxis`: 1 is y, 2 is z.
motion::ParticleParameters parametersOf(const ParticleSystem& system, int upAxis, uint32_t seed);
motion::EmitterParameters parametersOf(const Emitter& emitter, size_t number, uint32_t seed);

/// How many particles an emitter has born up to and with `time` (0 or more): whole numbers, not falling.
uint64_t bornUntil(const Emitter& emitter, double time);

/// More particles than this at a time are refused.
inline constexpr uint64_t kMostParticles = 200'000'000;
/// Memory that a particle takes while it is moved and splatted, for sentences.
inline constexpr uint64_t kBytesPerParticle = 96;

}  // namespace nephele
