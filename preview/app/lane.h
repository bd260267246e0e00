// One picture that gets better: coarse while things change, then accumulated until its noise is below a
// tolerance. Depends on gpu, volume/bricks.h and app/views.h; knows no window.
#pragma once

#include <optional>

#include "preview/app/views.h"
#include "preview/gpu/accumulator.h"
#include "preview/gpu/sharpen.h"
#include "preview/viewed_scene.h"

namespace nephele {

/// Everything that makes a picture begin anew when it changes.
struct LaneRequest {
  ViewedScene view;
  View show = View::radiance;
  Slice slice;
  int width = 0, height = 0;
};

/// When a picture at rest is good enough.
struct RestGoal {
  double tolerance = 0.005;  // relative noise
  unsigned most = 4096;      // samples, where the noise stays above
};

/// What a lane draws with.
struct LaneTools {
  const BrickVolume& bricks;
  const BrickAtlas& atlas;
  MarchPass& pass;
  const SharpenPass& sharpen;
  unsigned seed;
};

/// Head-up figures of one picture.
struct LaneStats {
  double quickMilliseconds = 0.0;  // the last coarse frame
  int quickWidth = 0, quickHeight = 0;
  double sampleMilliseconds = 0.0;  // one whole sample of every pixel at rest
  double raysCutShort = 0.0;  // by the driver, of the samples so far: the picture is wrong where it is not 0
  double densitySamplesPerPixel = 0.0;  // densities read for one sample of every pixel; 0 until one is whole
  SkipCheck skips;                      // of all samples so far, where the scene asks for it
  unsigned samples = 0;                 // whole ones, at rest
  unsigned samplesWanted = 0;           // as far as is known
  double noise = 0.0;                   // relative, as last measured; 0 until then
  double scale = 1.0;                   // upper end of the view's scale
};

/// Call restart() whenever view, scene or size change; it costs nothing. Then drawQuick() once, and work()
/// until it returns false.
class Lane {
 public:
  void restart(const LaneRequest& request);
  /// Whether the coarse picture for the last restart() is still to be drawn.
  bool quickNeeded() const { return quickNeeded_; }
  /// Draws it: fewer pixels, longer steps.
  void drawQuick(const LaneTools& tools);
  /// Draws samples of the whole picture for about `seconds`. Returns whether there is more to draw.
  bool work(const LaneTools& tools, double seconds, const RestGoal& goal);
  /// Whether anything is left to draw.
  bool unfinished() const { return quickNeeded_ || !accumulator_ || accumulator_->wholeSamples() < wanted_; }

  /// The best picture so far, or nullptr before any.
  const Film* best() const;
  const LaneRequest& request() const { return request_; }
  LaneStats stats() const;
  uint64_t gpuBytes() const;

 private:
  /// What is shown of quick_.
  void sharpenQuick(const LaneTools& tools);
  void beginRest(const LaneTools& tools, const RestGoal& goal);
  void lookAtFirstSample();
  void measureNoise(const RestGoal& goal);
  /// The upper end of the view's scale, for a film of one sample.
  void chooseScale(const Film& film);

  LaneRequest request_;
  int divisor_ = 2;             // of the coarse picture's sides; follows from the time that it takes
  double quickSeconds_ = 0.02;  // that the last one took; before any, about what it should take
  bool quickNeeded_ = false;
  bool scaleKnown_ = false;  // for the view that is shown
  std::optional<Film> quick_;
  std::optional<Film> sharpened_;  // of quick_, where that is enlarged and lit
  std::optional<Film> full_;
  std::optional<Accumulator> accumulator_;
  std::vector<float> firstHalf_;  // sums of radiance when half of check_ samples were whole
  unsigned check_ = 0;            // samples at which the noise is measured next
  unsigned wanted_ = 0;
  double fullSeconds_ = 0.0;
  LaneStats stats_;
};

}  // namespace nephele
