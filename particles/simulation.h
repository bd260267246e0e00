// Particles in motion: births, steps, deaths. The same system gives the same bits on any number of threads.
// Depends on base, TBB and the shared text.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "particles/particles.h"

namespace nephele {

/// One array a property, all of one length.
struct ParticleArrays {
  std::vector<float> x, y, z;      // world units
  std::vector<float> vx, vy, vz;   // own velocity, world units per second
  std::vector<float> age, life;    // seconds
  std::vector<float> radius;       // at birth
  std::vector<float> mass;         // at birth, density · world units³
  std::vector<float> temperature;  // at birth
  std::vector<uint32_t> id;        // emitter · 2^28 + number of its birth

  size_t size() const { return x.size(); }
  void resize(size_t count);
  /// Calls `body` with each float array, in the order above.
  template <class Body>
  void forEachFloats(const Body& body) {
    for (auto* array : {&x, &y, &z, &vx, &vy, &vz, &age, &life, &radius, &mass, &temperature}) body(*array);
  }
};

/// Where an emitter of shape mesh or points emits from.
struct Site {
  glm::vec3 position{0.0f};  // in the emitter's frame: its center is added
  glm::vec3 normal{0.0f};
  glm::vec3 velocity{0.0f};                                 // added to the emitter's
  std::optional<float> radius, density, life, temperature;  // in place of the emitter's
};
class SiteSource {
 public:
  virtual ~SiteSource() = default;
  /// How many sites there are; 0 where there is no end of them.
  virtual uint64_t count() const = 0;
  /// The n-th site; the same for the same n. n is below count() unless that is 0. Thread-safe.
  virtual Site site(uint64_t n, uint32_t seed) const = 0;
};
using SiteSourcePtr = std::shared_ptr<const SiteSource>;

/// Particles that left the range where they can be moved, or are too many: the sentence says which.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SimulationSettings {
  double fps = 24.0;
  int upAxis = 2;  // 1: y, 2: z
  uint32_t seed = 0;
};

/// How far from the origin, along each axis, particles can be moved: cells of every lattice they meet stay
/// whole numbers of 30 bits.
double farthestOf(const ParticleSystem& system);

/// Sums of birth masses so far, in density · world units³.
struct BirthLedger {
  double emitted = 0.0, died = 0.0;
  uint64_t countEmitted = 0, countDied = 0;
};

/// What a splat needs of each particle at one moment. Velocities include the flows that carry particles.
struct ParticleView {
  std::vector<float> x, y, z, vx, vy, vz, radius, mass, temperature, age;
  size_t size() const { return x.size(); }
};

class Simulation {
 public:
  /// `sources` has one entry an emitter, null where its shape needs none. Time is 0, and what is born at time
  /// 0 is there.
  Simulation(ParticleSystem system, std::vector<SiteSourcePtr> sources, const SimulationSettings& settings);

  /// One step of 1/(fps · substeps) seconds. Throws SimulationError.
  void step();
  uint64_t stepsDone() const { return steps_; }
  double secondsPerStep() const { return dt_; }
  const ParticleArrays& particles() const { return particles_; }
  const BirthLedger& ledger() const { return ledger_; }
  /// Radii and masses at their age, temperatures cooled.
  ParticleView view() const;

  /// The whole state as bytes that load() takes back: the same system goes on as if it had never stopped.
  std::string save() const;
  /// Returns false, with the state as it was, where the bytes are no state of this layout or are damaged.
  bool load(std::string_view bytes);

 private:
  void emit(double from, double to, bool first);
  void emitOne(size_t emitter, uint64_t number, double rest, double now, size_t at);
  void findNeighbours();
  void refuseRunaways() const;
  void removeDead();

  ParticleSystem system_;
  std::vector<SiteSourcePtr> sources_;
  std::vector<motion::EmitterParameters> emitters_;
  mutable motion::Motion motion_;  // GLSL has no word for functions that change nothing, as all of its do
  double dt_;
  double farthest_;
  uint64_t steps_ = 0;
  ParticleArrays particles_;
  std::vector<motion::Motion::NeighbourSums> neighbours_;
  std::vector<uint64_t> born_;  // of each emitter
  BirthLedger ledger_;
};

}  // namespace nephele
