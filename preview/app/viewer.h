// What the window shows: one volume on the window's context, seen once or, split, under two settings.
// Depends on gpu, scene, volume/bricks.h and app/lane.h; knows no window.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <tuple>

#include "preview/app/lane.h"
#include "preview/behind.h"
#include "preview/gpu/seen_volume.h"

namespace nephele {

/// The two sides of a split; without one, only `edited` is drawn.
enum class Side { edited, kept };
inline constexpr int kSideCount = 2;

/// How a picture is put into the window, apart from what it shows.
struct Shown {
  Scene scene;  // for backdrop and environment
  double exposureEv = 0.0;
};

/// Where the sides lie: `kept` left of `divider` (a share of the width), `edited` right of it. 0: no split.
struct Screen {
  unsigned framebuffer = 0;  // GL name; 0: the window's own
  int width = 0, height = 0;
  double divider = 0.0;
};

/// Set a volume first. Call restart() whenever view, scene or size change; it costs nothing. Then work()
/// until it returns false.
class Viewer {
 public:
  /// The context is current.
  Viewer(Filter filter, unsigned seed, uint64_t vramBytes = 0);

  /// Uploads the bricks and keeps them. Where they do not fit, the volume before stays and the reason is
  /// thrown: InputError or WorldError. Pictures must be restarted.
  void setVolume(std::shared_ptr<const BrickVolume> bricks);
  const BrickVolume& volume() const { return *bricks_; }
  /// The same for a volume whose densities are written on the GPU, into liveAtlas(): floats at every brick's
  /// place.
  void setLiveVolume(std::shared_ptr<const BrickVolume> bricks);
  /// nullptr where setVolume() came last.
  BrickAtlas* liveAtlas() { return live_ ? &*live_ : nullptr; }

  void restart(Side side, const LaneRequest& request);
  /// Forgets the kept side.
  void endSplit();
  void setGoal(const RestGoal& goal) { goal_ = goal; }
  /// Draws for about `seconds`: first coarse pictures, then samples of the full ones. Returns whether there
  /// is more to draw. Throws InputError for settings that cannot be drawn.
  bool work(double seconds);
  /// Puts the best pictures so far onto the screen, through backdrop or environment and the tone curve, or as
  /// colours of a scale.
  void show(const Screen& screen, const std::array<Shown, kSideCount>& shown);
  /// The edited side's best picture so far, as linear planes; of one pixel without medium before any.
  Picture read() const;
  /// World distance from the camera to what is seen at a share of the edited picture's sides from its top
  /// left corner; 0 where there is no medium.
  double depthAt(double x, double y) const;
  LaneStats stats(Side side) const;
  /// Bricks, index, pictures and parameters.
  uint64_t gpuBytes() const;
  /// Without the pictures: bricks, index, light caches and what else marching takes.
  uint64_t volumeBytes() const;
  /// What bricks of the file are kept in for the edited side; nullopt before its first picture and for live
  /// ones.
  std::optional<Texel> texel() const { return seen_ ? seen_->texelOf(0) : std::nullopt; }

 private:
  MarchPass& passFor(View view);
  LaneTools toolsFor(const Lane& lane, bool moving);
  /// What puts such a picture into the window.
  const GlProgram& displayFor(const LaneRequest& request, const Scene& shown);
  void showSide(size_t side, const Shown& shown, const Screen& screen);

  Filter filter_;
  unsigned seed_;
  GpuLimits limits_;
  RestGoal goal_;
  std::shared_ptr<const BrickVolume> bricks_;
  std::optional<SeenVolume> seen_;
  std::optional<BrickAtlas> live_;                  // in place of what seen_ would make
  std::array<std::optional<MarchPass>, 3> passes_;  // by MarchWrites; compiled when first needed
  std::map<std::tuple<View, Behind, bool>, GlProgram>
      displays_;  // the last: a lat-long picture; built when first needed
  std::array<GlBuffer, kSideCount> displayParameters_;  // for rays to the sky
  GlVertexArray noVertices_;
  std::optional<SharpenPass> sharpen_;  // made when first needed
  std::array<std::optional<Lane>, kSideCount> lanes_;
};

}  // namespace nephele
