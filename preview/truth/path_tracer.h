// Paths of light through a medium, camera first: unbiased radiance along one ray. Depends on preview/truth
// alone.
#pragma once

#include "preview/truth/emitter.h"
#include "preview/truth/light_sources.h"
#include "preview/truth/phase.h"
#include "preview/truth/stage.h"
#include "preview/truth/tracking.h"

namespace nephele::truth {

struct PathSettings {
  int bounces = -1;  // scatterings after the first, of emitted light too; −1: without limit
  bool lightSampling =
      true;  // false: light is met by chance alone, and every distance is drawn by delta tracking
};

/// One sample of a ray.
struct PathSample {
  glm::vec3 radiance{0.0f};  // scattered and emitted towards the camera
  glm::vec3 transmittance{1.0f};
  float taken = 0.0f;     // weight of `distance`; its expectation is 1 − transmittance, mean over channels
  float distance = 0.0f;  // world units from the ray's origin to the first scattering
};

/// Which of a pixel's stratified points a path draws from.
struct StratifiedPoint {
  uint32_t number = 0;
  uint64_t seed = 0;
};

/// Safe to use from many threads.
class PathTracer {
 public:
  /// Medium, lights, emitter and stage, where there are such, outlive the tracer. The stage's things shadow
  /// the medium; scattered light that would meet them is not followed, so they take `bounces` of 0.
  PathTracer(const TrackedMedium& medium, const PhaseFunction& phase, const LightSources& lights,
             const PathSettings& settings, const Emitter* emitter = nullptr,
             const StageSurfaces* stage = nullptr)
      : medium_(medium),
        phase_(phase),
        lights_(lights),
        settings_(settings),
        emitter_(emitter),
        stage_(stage) {}

  /// `ray` starts in the brick grid or on its face, `along` is its unit direction in world axes; `point`'s
  /// dimensions from 2 on are used here (0 and 1 place the sample in its pixel). Every contribution is finite
  /// and at least 0.
  PathSample trace(const TrackedRay& ray, const glm::vec3& along, const StratifiedPoint& point,
                   Random& random, uint64_t& looks) const;

 private:
  struct Vertex;
  /// To the first thing on the stage.
  float wayFrom(const glm::vec3& position, const glm::vec3& along) const {
    return stage_ != nullptr ? stage_->wayFrom(position, along) : std::numeric_limits<float>::infinity();
  }
  glm::vec3 gather(Vertex& vertex, Random& random, uint64_t& looks) const;
  glm::vec3 lightFromSources(const Vertex& vertex, float choice, Random& random, uint64_t& looks) const;
  glm::vec3 lightFromSky(const Vertex& vertex, float u1, float u2, Random& random, uint64_t& looks) const;
  glm::vec3 emitted(const glm::vec3& arriving, const glm::vec3& position) const;
  bool goOn(Vertex& vertex, glm::vec3& radiance, Random& random, uint64_t& looks) const;
  bool survives(Vertex& vertex, Random& random) const;

  const TrackedMedium& medium_;
  PhaseFunction phase_;
  const LightSources& lights_;
  PathSettings settings_;
  const Emitter* emitter_;
  const StageSurfaces* stage_;
};

}  // namespace nephele::truth
