// How light crosses the medium: unbiased transmittance, and where it scatters. Depends on volume/bricks.h and
// GLM. Positions are voxels from the corner of the brick grid, distances world units; a ray's direction holds
// voxels per world unit.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "preview/truth/control_grid.h"
#include "preview/truth/random.h"

namespace nephele::truth {

/// What is tracked through. Safe to use from many threads.
struct TrackedMedium {
  const BrickVolume* bricks = nullptr;
  ControlGrid grid;
  glm::vec3 sigmaT{0.0f};  // per unit density per world unit
  glm::vec3 sigmaS{0.0f};
  float sigmaMax = 0.0f;  // of sigmaT; > 0
  bool grey = true;       // all channels of sigmaT are one
  glm::mat3 indexFromWorld{1.0f}, worldFromIndex{1.0f};
};

/// σ_s/σ_t and σ_a/σ_t per channel; 0 where nothing is taken.
glm::vec3 scatteredShare(const TrackedMedium& medium);
glm::vec3 absorbedShare(const TrackedMedium& medium);

struct TrackedRay {
  glm::vec3 origin, direction;
  float reach = std::numeric_limits<float>::infinity();  // world units
};

/// Trilinear density at a position in `cell`.
float densityIn(const TrackedMedium& medium, const ControlCell& cell, const glm::vec3& position);

/// An unbiased estimate of e^(−∫ σ_t ρ ds) per channel, never negative. Residual ratio tracking [Novák et al.
/// 2014]: the control's optical depth in closed form, and at random places, `residual` of them per world
/// unit, a factor 1 − σ (ρ − control)/residual. Rays through more than a few optical depths end by Russian
/// roulette. `looks` counts densities read.
glm::vec3 transmittance(const TrackedMedium& medium, const TrackedRay& ray, Random& random, uint64_t& looks);

/// One scattering on a camera ray, and the whole ray's transmittance.
struct FirstScattering {
  bool found = false;
  glm::vec3 position{0.0f};
  float distance = 0.0f;
  glm::vec3 weight{0.0f};    // of scattered light: σ_s ρ T over the density with which the place was drawn
  glm::vec3 absorbed{0.0f};  // σ_a ρ T over the same: of what the place emits
  float taken = 0.0f;        // mean over channels of σ_t ρ T over that density: its expectation is 1 − T
  glm::vec3 transmittance{1.0f};  // an unbiased estimate
};

/// Lists all along the ray that may scatter, with its share of the light (in smooth cells by the control in
/// closed form, elsewhere by ratio tracking [Cramer 1978; PBRT, 11.2]), and chooses a place from the list by
/// `u` in [0, 1), so that evenly spread u give evenly spread places. `channel` in [0, 1) chooses within a
/// coloured medium.
FirstScattering firstScattering(const TrackedMedium& medium, const TrackedRay& ray, float u, float channel,
                                Random& random, uint64_t& looks);

/// Delta tracking [Woodcock 1965] to the next collision; in coloured media with the probabilities of spectral
/// tracking [Kutz et al. 2017], which keep `weight`'s channels bounded. True where one is found: `ray.origin`
/// is then its place, `weight` has been multiplied by the albedo, and `arriving`, where it is asked for, is
/// the weight before that. False where the ray left the medium. In a grey medium of albedo 1 the weight never
/// changes.
bool nextCollision(const TrackedMedium& medium, TrackedRay& ray, glm::vec3& weight, Random& random,
                   uint64_t& looks, glm::vec3* arriving = nullptr);

}  // namespace nephele::truth
