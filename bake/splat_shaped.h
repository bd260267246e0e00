// Stretched and eroded particles: their kernels on 8³ voxels, in a field that each reads in its own frame.
// Part of splat; depends on splat_places.h, splat_kernels.h, no OpenVDB.
#pragma once

#include "bake/splat_places.h"

namespace nephele {

/// Immutable, safe to share between threads; keeps references to its arguments.
class SplatShaping {
 public:
  SplatShaping(const SplatParticles& particles, const SplatSettings& settings)
      : particles_(particles), settings_(settings) {}

  /// The particle's kernel, not scaled, on the 8³ voxels from `origin` (in the grid's frame): weights[512]
  /// and their sum. Where the particle surely does not reach, the sum is 0 and the weights are left as they
  /// are.
  double weights(size_t particle, const SplatFrame& frame, const glm::ivec3& origin, float* weights) const;
  /// Σ weights over all voxels: 0 where the field has eaten all of it.
  double sum(size_t particle, const SplatFrame& frame) const;

 private:
  const float* fieldAt(size_t particle, const SplatFrame& frame, const glm::ivec3& origin,
                       float* values) const;

  const SplatParticles& particles_;
  const SplatSettings& settings_;
};

}  // namespace nephele
