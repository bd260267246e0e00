// Camera rays over the look-dev stage: what the medium scatters before a surface, the surface through the
// medium, and mirrors. Depends on preview/truth alone.
#pragma once

#include "preview/truth/camera.h"
#include "preview/truth/path_tracer.h"
#include "preview/truth/stage.h"

namespace nephele::truth {

/// One sample of a camera ray. Behind a surface nothing is seen: transmittance is then 0.
struct StagedSample {
  glm::vec3 radiance{0.0f};
  glm::vec3 transmittance{1.0f};
  float taken = 0.0f;          // weight of the distances
  float takenDistance = 0.0f;  // weighted, world units
};

/// Unbiased, to the first order: light that is scattered or reflected by a Lambert surface once on its way to
/// the camera, and by at most two mirrors besides. Things and medium shadow each other. Safe to use from many
/// threads. What is passed in outlives it.
class StagedTracer {
 public:
  StagedTracer(const StageSurfaces& surfaces, const CameraRays& rays, const PathTracer& tracer,
               const TrackedMedium& medium, const LightSources& lights)
      : surfaces_(surfaces), rays_(rays), tracer_(tracer), medium_(medium), lights_(lights) {}

  StagedSample trace(const glm::dvec3& from, const glm::dvec3& towards, const StratifiedPoint& point,
                     Random& random, uint64_t& looks) const;

 private:
  glm::vec3 shade(const StageHit& hit, const glm::dvec3& place, Random& random, uint64_t& looks) const;
  glm::vec3 through(const glm::dvec3& place, const glm::vec3& along, double reach, Random& random,
                    uint64_t& looks) const;

  const StageSurfaces& surfaces_;
  const CameraRays& rays_;
  const PathTracer& tracer_;
  const TrackedMedium& medium_;
  const LightSources& lights_;
};

}  // namespace nephele::truth
