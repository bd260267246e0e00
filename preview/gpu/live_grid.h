// The stage `rebuild` of live particles: clear, splat in whole units, resolve into an atlas of bricks and its
// index, all on the GPU. Depends on gpu/live_motion.h, gpu/brick_atlas.h and volume/bricks.h.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "preview/gpu/brick_atlas.h"
#include "preview/gpu/live_motion.h"

namespace nephele {

/// Voxels of a live grid: sample (i, j, k) lies at voxelSize · (i, j, k), as in a bake.
struct LiveBox {
  glm::ivec3 low{0}, size{1};
  double voxelSize = 1.0;
  bool operator==(const LiveBox&) const = default;
};

/// The longest edge of a live grid, voxels.
inline constexpr int kMostLiveEdge = 128;

/// Voxels that hold a box of the world, `edge` of them along its longest side: from 8 to kMostLiveEdge.
LiveBox liveBox(const MotionBox& box, int edge);

/// A volume of that box whose bricks all have a place in an atlas, for LiveGrid to write into; metadata,
/// names and figures as `like`.
BrickVolume liveVolume(const LiveBox& box, const BrickVolume& like);

/// Used with one context current.
class LiveGrid {
 public:
  /// `changes` are for tests.
  explicit LiveGrid(const std::vector<TextChange>& changes = {});

  /// Writes the particles' density as it is now into an atlas of a liveVolume() of the box, its index too.
  /// `mostMass`: the most that there can be at any time (particles/live_plan.h). Does not wait for the GPU.
  void rebuild(const LiveMotion& motion, const LiveBox& box, double mostMass, BrickAtlas& atlas);

  /// One unit of the grid as density: what two voxels can differ by. A voxel errs by at most one unit a
  /// particle.
  static double unitOf(const LiveBox& box, double mostMass, uint32_t slots);
  /// No density can exceed this.
  static double boundOf(const LiveBox& box, double mostMass);

  /// Sums of all voxels in units, x fastest, for tests. Waits for the GPU.
  std::vector<uint32_t> readSums() const;
  uint64_t gpuBytes() const { return gpuBytes_; }

 private:
  void shape(const LiveBox& box, const BrickAtlas& atlas, uint32_t slots);
  void upload(const LiveMotion& motion, double mostMass);
  const GlProgram& splat(const LiveMotion& motion, bool wide);

  std::vector<TextChange> changes_;
  std::map<std::vector<std::string>, GlProgram> splats_;
  GlProgram resolve_, index_;
  GlBuffer grid_, sums_, wide_, corners_, largest_;
  LiveBox box_;
  glm::ivec3 offset_{0}, bricks_{0};
  uint64_t atlasSerial_ = 0;
  uint32_t slots_ = 0;
  uint64_t gpuBytes_ = 0;
};

}  // namespace nephele
