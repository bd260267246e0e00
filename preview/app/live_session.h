// Particles that move while the window is open: a system on the GPU, its grid, and when its next frame is
// due. Depends on gpu, particles and app/live_recipe.h; knows no window.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "preview/app/live_recipe.h"
#include "preview/gpu/live_grid.h"

namespace nephele {

/// Used with one context current.
class LiveSession {
 public:
  static constexpr int kUsualEdge = 64;

  /// Begins at time 0, playing, in a grid of `edge` voxels along the longest side of the box that some
  /// hundred of the particles come through in `frames` frames, or of the system's own box. Figures for looks
  /// are those of `like`. Throws SimulationError for a system that is not simulated live, or whose particles
  /// never are.
  LiveSession(const LiveSource& source, const ParticleSystem& system, const BrickVolume& like, int64_t frames,
              int edge);

  /// What the viewer must hold: another one where the box has changed.
  std::shared_ptr<const BrickVolume> volume() const { return volume_; }

  /// Takes over parameters, or voxels. Throws SimulationError, with all as it was.
  void setSystem(const ParticleSystem& system);
  void setEdge(int edge);
  int edge() const { return edge_; }
  /// Back to time 0, in a box found anew.
  void reset();
  void play(bool on) { playing_ = on; }
  bool playing() const { return playing_; }
  /// One frame on, and no further.
  void stepFrame();

  /// Moves on where a frame is due and rebuilds the grid in `atlas`, which must be of volume(). Returns
  /// whether there is another picture to draw.
  bool advance(double seconds, BrickAtlas& atlas);
  /// Seconds until the next frame is due; nullopt while it rests.
  std::optional<double> due() const;
  /// A sentence on what stopped it, once; empty otherwise.
  std::string takeTrouble() { return std::exchange(trouble_, {}); }

  /// Frames since the recipe's frame 0; below 0 while it is prewarmed.
  int64_t frame() const;
  uint32_t alive() const { return status_.alive; }
  const LiveBox& box() const { return box_; }
  uint64_t gpuBytes() const { return motion_.gpuBytes() + grid_.gpuBytes(); }

 private:
  void findBox();
  void makeVolume();
  void look();
  int64_t substeps() const { return motion_.system().substeps; }

  BrickVolume like_;  // without its bricks
  int64_t frames_;
  int edge_;
  LiveMotion motion_;
  LiveGrid grid_;
  MotionBox found_{};
  LiveBox box_;
  std::shared_ptr<BrickVolume> volume_;
  std::string written_;  // the system as YAML, to know another one by
  double mostMass_ = 0.0;
  bool playing_ = true, stale_ = true;  // stale: the grid is not of the particles as they are
  double clock_ = 0.0, sinceLook_ = 0.0;
  LiveStatus status_;
  std::string trouble_;
};

}  // namespace nephele
