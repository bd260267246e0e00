// The stage `move` of live particles: a particle system on the GPU, stepped by the shared text from the same
// seeds as particles/simulation.h. Depends on particles, gpu/gl.h and gpu/shader.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "particles/live_plan.h"
#include "preview/gpu/shader.h"

namespace nephele {

/// A particle as its slot holds it: shaders/live_particles.glsl.
struct LiveParticle {
  motion::vec4 place;   // world units; w: age
  motion::vec4 motion;  // own velocity; w: life
  motion::vec4 born;    // radius, mass, temperature at birth; 0
};

/// What the stages counted.
struct LiveStatus {
  uint32_t alive = 0;     // at the last rebuild
  uint32_t runaways = 0;  // particles that left the range where they can be moved, since the last reset
  uint32_t crowded = 0;   // particles with more neighbours than can be looked at, likewise
};

/// Used with one context current. Its particles never leave the GPU but for read().
class LiveMotion {
 public:
  /// Time is 0, and what is born at time 0 is there. Throws SimulationError as slotRings() does, WorldError
  /// where the driver refuses. `changes` are for tests.
  LiveMotion(const ParticleSystem& system, const SimulationSettings& settings,
             const std::vector<TextChange>& changes = {});

  /// Takes over other parameters. Particles live on where their slots stay the same; else time begins anew,
  /// and the result is true. Throws SimulationError, with all as it was.
  bool setSystem(const ParticleSystem& system);
  void reset();
  /// One step of 1/(fps · substeps) seconds. Does not wait for the GPU.
  void step();

  uint64_t stepsDone() const { return steps_; }
  double secondsPerStep() const { return dt_; }
  double seconds() const { return static_cast<double>(steps_) * dt_; }
  const ParticleSystem& system() const { return system_; }
  const SimulationSettings& settings() const { return settings_; }
  const std::vector<SlotRing>& rings() const { return rings_; }
  uint32_t slotCount() const { return slotCount_; }
  /// Binds slots, status, parameters and step to where shaders/live_particles.glsl declares them.
  void bind() const;
  /// Sets the count of those alive to 0, before a rebuild counts them.
  void clearCount() const;
  uint64_t gpuBytes() const;

  /// Waits for the GPU.
  LiveStatus status() const;
  /// All slots, for tests. Waits for the GPU.
  std::vector<LiveParticle> read() const;
  /// The number of the birth that a slot of this ring was last taken by, or nullopt before any.
  std::optional<uint64_t> birthOf(size_t emitter, uint32_t slot) const;
  /// Puts particles into the first slots, as many as there are, and frees the rest: for tests.
  void place(const std::vector<LiveParticle>& particles);

 private:
  void allocate();
  void upload();
  void dispatch(double from, double to, bool first);
  void findNeighbours() const;
  bool seesNeighbours() const { return system_.forces.neighbourReach > 0.0; }

  ParticleSystem system_;
  SimulationSettings settings_;
  double dt_;
  std::vector<SlotRing> rings_;
  uint32_t slotCount_ = 0, bucketCount_ = 0;
  uint64_t steps_ = 0;
  std::vector<uint64_t> born_;  // of each emitter
  GlProgram move_, moveAmong_;
  std::vector<GlProgram> neighbourStages_;
  GlBuffer slots_, status_, parameters_, step_;
  GlBuffer neighbours_, buckets_, entries_;
};

}  // namespace nephele
