// The frames of one particle asset: simulated once, restarted from checkpoints, splatted and written. Depends
// on pipeline, splat, particles, base; no OpenVDB.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "bake/pipeline.h"
#include "bake/splat.h"
#include "particles/simulation.h"
#include "volume/chords.h"

namespace nephele {

/// Where a frame's mass went, in density · world units³: emitted = died + faded + alive, alive = outsideBox +
/// splatted (up to rounding), splatted = stored + lostToCutoff + lostToHalf.
struct MassLedger {
  double emitted = 0.0, died = 0.0, faded = 0.0, alive = 0.0;
  double outsideBox = 0.0, splatted = 0.0, lostToCutoff = 0.0, lostToHalf = 0.0, stored = 0.0;
  uint64_t countEmitted = 0, countAlive = 0;
};

struct ParticleFrame {
  Splatted splatted;
  MassLedger mass;
  uint64_t stepsSimulated = 0;  // for this frame; few where a checkpoint or the frame before was there
  double secondsSimulate = 0.0, secondsSplat = 0.0;
};

/// Not thread-safe; frames are cheapest in growing order. With `stable_box` all frames of the asset are
/// simulated before the first is splatted, unless that box lies beside the checkpoints already.
class ParticleRun {
 public:
  /// Keeps references to both. Checkpoints lie in `outFolder`/NAME.checkpoints. Throws InputError where a
  /// file that an emitter names cannot be used.
  ParticleRun(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder);
  ~ParticleRun();

  /// The state at `frame` (0 for an asset without frames), splatted. Writes the checkpoints that it passes.
  /// Throws InputError on particles that cannot be moved or splatted and on a loss beyond the asset's
  /// mass_tolerance, WorldError where a checkpoint cannot be written.
  ParticleFrame frame(std::optional<int> frame);

  /// Brings the particles to `frame` and splats nothing; returns the steps that it took. Throws as frame().
  uint64_t moveTo(std::optional<int> frame);
  /// The particles as they are, splatted with the voxel size, precision, density step and cutoff of `look`,
  /// an asset like the run's own. Throws InputError on particles that cannot be splatted.
  Splatted splatted(const Asset& look) const;
  /// The same without the grids beside density, and with those voxels alone that the rays read.
  Splatted densityAlong(std::span<const Chord> chords, const Asset& look) const;

  /// The box of the particles as they are, with their radii; empty where there are none.
  Box extent() const;

  /// The points of the last frame, as files of points hold them.
  void writePointsBeside(const std::string& vdbFile) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nephele
