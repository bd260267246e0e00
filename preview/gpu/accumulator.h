// Samples of a picture, drawn in pieces so short that no driver's watchdog trips and a window stays awake.
// Depends on gpu/march_pass.h.
#pragma once

#include <limits>

#include "preview/gpu/march_pass.h"

namespace nephele {

/// Walks over samples and, within each, over rectangles of rows, whose size follows from the time the last
/// one took. What is drawn does not depend on how it is cut up.
class Accumulator {
 public:
  /// Draws `samples` samples a pixel for `seed` into a film of the given size, which must be clear. Samples
  /// cover `pixelEdge` of a pixel along each axis from its top left corner.
  Accumulator(int width, int height, unsigned samples, unsigned seed, float pixelEdge = 1.0f);

  /// Draws and waits for the GPU until `seconds` are over (at least one piece), `until` samples are whole or
  /// all is done. Returns false once all is done.
  bool advance(MarchPass& pass, const BrickAtlas& atlas, const Film& film, double seconds,
               unsigned until = std::numeric_limits<unsigned>::max());

  bool done() const { return sample_ >= samples_; }
  unsigned wholeSamples() const { return sample_; }
  /// Pixels drawn so far, over all samples, and their number when done.
  uint64_t pixelsDone() const;
  uint64_t pixelsTotal() const;

 private:
  PixelRectangle next() const;
  void moveOn(const PixelRectangle& drawn);

  int width_;
  int height_;
  unsigned samples_;
  unsigned seed_;
  float pixelEdge_;
  unsigned sample_ = 0;
  int x_ = 0;
  int y_ = 0;
  int64_t piecePixels_;
};

}  // namespace nephele
