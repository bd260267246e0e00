// Stretched and eroded particles: their kernels on 8³ voxels, or on some of them, in a field that each reads
// in its own frame.
// Part of splat; depends on splat_places.h, splat_kernels.h, no OpenVDB.
#pragma once

#include <atomic>
#include <vector>

#include "bake/splat_places.h"

namespace nephele {

/// Weights that may be kept from sum() for weights(), so that a field is evaluated once: 512 MiB.
inline constexpr size_t kKeptWeightsBytes = size_t(512) << 20;

/// Of two lattices of voxels, one half as far apart as the other, sumOfFewer() takes the finer where their
/// sums differ by at most this share. Its own error is a few times smaller, and as often up as down.
inline constexpr double kMassTolerance = 0.004;

/// A leaf of which some voxels are asked for.
struct PartOfLeaf {
  glm::ivec3 origin{0};  // in the grid's frame, a multiple of 8
  LeafMask voxels{};
  float* sums = nullptr;  // [512]
};

/// Keeps references to its arguments.
class SplatShaping {
 public:
  SplatShaping(const SplatParticles& particles, const SplatSettings& settings,
               size_t keptBytes = kKeptWeightsBytes)
      : particles_(particles), settings_(settings), keptBytes_(keptBytes) {}

  /// Σ of the particle's kernel, not scaled, over all voxels: 0 where the field has eaten all of it. Keeps
  /// its weights while there is room. Threads may ask for different particles at once, after makeRoom().
  double sum(size_t particle, const SplatFrame& frame);
  /// The same, to kMassTolerance, from every second voxel along each axis, every fourth …; keeps nothing.
  double sumOfFewer(size_t particle, const SplatPlaces& places) const;
  /// One entry for each particle; until then nothing is kept.
  void makeRoom() { kept_.resize(particles_.size()); }

  /// The kernel on the 8³ voxels from `origin` (in the grid's frame, a multiple of 8): weights[512]. False,
  /// and weights left as they are, where the particle does not reach. The same numbers whether they were kept
  /// or not. Safe to share between threads.
  bool weights(size_t particle, const SplatFrame& frame, const glm::ivec3& origin, float* weights) const;
  /// Adds `scale` times the kernel to some voxels of leaves that lie near each other, asking for the field at
  /// many at once. Safe to share between threads.
  void add(size_t particle, const SplatFrame& frame, float scale, std::span<const PartOfLeaf> leaves) const;

 private:
  /// One leaf's weights above 0.
  struct KeptLeaf {
    uint64_t above[kLeafVoxels / 64] = {};  // a bit a voxel
    uint32_t first = 0;                     // of its weights in Kept::weights
  };
  struct Kept {
    std::vector<KeptLeaf> leaves;  // of the box that the particle can reach; empty where nothing was kept
    std::vector<float> weights;
    void add(const float* weights);
    size_t bytes() const { return leaves.size() * sizeof(KeptLeaf) + weights.size() * sizeof(float); }
  };

  struct Places;
  /// Σ over all voxels; body(weights) for each leaf of the frame's box, null for one that is not reached.
  template <class Body>
  double sumOver(size_t particle, const SplatFrame& frame, const Body& body) const;
  void readField(size_t particle, const Places& places, float* values) const;
  double evaluate(size_t particle, const SplatFrame& frame, const glm::ivec3& origin, float* weights) const;
  const float* fieldAt(size_t particle, const SplatFrame& frame, const glm::ivec3& origin,
                       float* values) const;

  const SplatParticles& particles_;
  const SplatSettings& settings_;
  const size_t keptBytes_;
  std::atomic<size_t> usedBytes_{0};
  std::vector<Kept> kept_;
};

}  // namespace nephele
