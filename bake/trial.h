// Bakes in memory, to be measured and thrown away: one asset at any voxel size, precision, density
// step, octaves and cutoff. Depends on pipeline, voxelize, splat, particle_run; no OpenVDB.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline.h"
#include "volume/bricks.h"
#include "volume/chords.h"

namespace nephele {

struct TrialBake {
  BrickVolume bricks;
  uint64_t voxelsActive = 0;
  double maximum = 0.0;
  uint64_t gridBytes = 0;  // in memory
  uint64_t fileBytes = 0;  // 0 where no file was asked for
  double seconds = 0.0;    // of filling, and of writing where a file was asked for
  std::vector<BandLimitNote> notes;
};

/// One asset at some of its frames. Not thread-safe; keeps references to its arguments.
class TrialBaker {
 public:
  /// `frames` holds nullopt alone for an asset without frames. Particles are moved to each of them once;
  /// their checkpoints lie in `outFolder`. Throws as ParticleRun does.
  TrialBaker(const Pipeline& pipeline, const Asset& asset, std::vector<std::optional<int>> frames,
             const std::string& outFolder);
  ~TrialBaker();

  size_t frameCount() const;
  /// The asset's frame with the voxel size, precision, density step, octaves and cutoff of `look`, an asset
  /// like it. Writes the file as well where `file` is not empty. Throws InputError on what cannot be baked.
  TrialBake bake(size_t frame, const Asset& look, const std::string& file = {}) const;

  /// `count` chords of the sphere round what the frame holds, found by a coarse bake; each seed has its own.
  Chords chords(size_t frame, uint64_t count, uint64_t seed) const;
  struct Depths {
    std::vector<double> depths;  // one a chord
    double voxels = 0.0;         // about as many active ones, but for constant space
    double maximum = 0.0;        // of the densities that rays come near
  };
  /// Optical depths of bake(frame, look) along chords of the frame. Only voxels that rays come near are
  /// evaluated; masses of wide eroded particles are found from some of theirs (kMassTolerance).
  Depths depths(size_t frame, const Asset& look, const Chords& chords) const;

  /// The longest and the shortest side of the box outside which the density is 0, world units; 0 where it is
  /// empty or without end.
  struct Extent {
    double longest = 0.0, shortest = 0.0;
  };
  Extent extent() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// First, middle and last of the asset's frames, each once; nullopt alone where it has none.
std::vector<std::optional<int>> sampledFrames(const Asset& asset);

/// The largest number of octaves that any field of the asset asks for; 0 where none has octaves.
int largestOctaves(const Asset& asset);

}  // namespace nephele
