// What the window shows: the march on the window's context, coarse while things change, accumulated while
// they rest. Depends on gpu, scene and volume/bricks.h; knows no window.
#pragma once

#include <optional>

#include "preview/gpu/accumulator.h"
#include "preview/viewed_scene.h"

namespace nephele {

/// Head-up figures.
struct ViewerStats {
  double quickMilliseconds = 0.0;   // the last coarse frame
  double sampleMilliseconds = 0.0;  // one whole sample of every pixel at rest
  double raysCutShort = 0.0;  // by the driver, of the samples above: the picture is wrong where it is not 0
  double densitySamplesPerPixel = 0.0;  // densities read for one sample of every pixel; 0 until one is whole
  unsigned samples = 0;                 // accumulated at rest
  unsigned samplesWanted = 0;
  uint64_t gpuBytes = 0;
};

/// Call restart() whenever view, scene or size change; it costs nothing. Then work() until it returns false.
class Viewer {
 public:
  static constexpr unsigned kRestSamples = 128;

  /// The context is current. Keeps a reference to the bricks.
  Viewer(const BrickVolume& bricks, Filter filter, unsigned seed);

  void restart(const ViewedScene& view, int width, int height);
  /// Draws for about `seconds`: first a coarse picture (fewer pixels, longer steps), then samples of the full
  /// one. Returns whether there is more to draw.
  bool work(double seconds);
  /// Puts the best picture so far into the window's framebuffer, through backdrop or environment and the tone
  /// curve.
  void show(const Scene& scene, double exposureEv, int width, int height) const;
  /// The best picture so far, as linear planes.
  Picture read() const;
  ViewerStats stats() const;

 private:
  void drawQuick();
  const Film& best() const;

  const BrickVolume& bricks_;
  unsigned seed_;
  MarchPass pass_;
  BrickAtlas atlas_;
  GlProgram display_;
  GlBuffer displayParameters_;
  GlVertexArray noVertices_;
  ViewedScene view_;
  int width_ = 0, height_ = 0;
  int divisor_ = 3;  // of the coarse picture's sides; follows from the time that it takes
  bool quickNeeded_ = false;
  std::optional<Film> quick_;
  std::optional<Film> full_;
  std::optional<Accumulator> accumulator_;
  double fullSeconds_ = 0.0;
  ViewerStats stats_;
};

}  // namespace nephele
