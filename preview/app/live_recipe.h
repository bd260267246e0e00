// The particle system that a baked file carries in its metadata, and the recipe that bakes it again. Depends
// on particles, scene, volume/bricks.h and base.
#pragma once

#include <optional>
#include <string>

#include "particles/simulation.h"
#include "volume/bricks.h"

namespace nephele {

/// What a file of particles says of its making.
struct LiveSource {
  ParticleSystem system;
  SimulationSettings settings;
  std::string name;        // the asset's
  double voxelSize = 1.0;  // world units
  double cutoff = 0.001;
  double densityStep = 0.0;  // 0: none
  bool half = true;
  bool framed = false;  // whether the file is a frame of a sequence
};

/// Reads it from a volume's metadata; nullopt where it has no particle block. Throws InputError where it has
/// one that cannot be read.
std::optional<LiveSource> liveSourceOf(const BrickVolume& volume);

/// Half-open.
struct FrameRange {
  int begin = 0, end = 1;
};

/// A recipe of one asset `name` that bakes `system` as the source's file was baked: its voxels, frames, seed
/// and rate. `scene`: YAML that stands under scene:, may be empty.
std::string recipeOf(const LiveSource& source, const ParticleSystem& system, const std::string& name,
                     const std::optional<FrameRange>& frames, const std::string& scene);

/// Writes a recipe to FOLDER/NAME_live.yaml, or with a letter behind it (NAME_live_b.yaml …) where there is
/// one already, whole or not at all. The asset is named like the file. Returns its path. Throws WorldError.
std::string writeLiveRecipe(const std::string& folder, const LiveSource& source, const ParticleSystem& system,
                            const std::optional<FrameRange>& frames, const std::string& scene);

}  // namespace nephele
