// Float targets in which samples of a picture are summed on the GPU, and their means as a picture.
// Depends on base/picture.h and gpu/gl.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/picture.h"
#include "preview/gpu/gl.h"

namespace nephele {

/// What a film holds after division by the samples of each pixel: the planes R, G, B, A, transmittance.R,
/// transmittance.G, transmittance.B and depth (world units from the camera; 0 where there is no medium).
struct FilmPicture {
  Picture picture;
  double densitySamples = 0.0;  // densities read, summed over all pixels and samples
  double raysCutShort = 0.0;  // samples whose loops the driver ended before their time: the picture is wrong
};

/// Three RGBA32F targets of one size: radiance and alpha; transmittance and the number of samples; weighted
/// depth, its weight, densities read, rays cut short. Row 0 is the picture's top.
class Film {
 public:
  /// Sums start at 0. Throws InputError where a side is over the driver's limit, WorldError where memory is
  /// short.
  Film(int width, int height);

  void clear();
  /// Makes the film the target of draws, which add to it.
  void bindAsTarget() const;
  /// Binds the three targets' sums to texture units 0, 1 and 2, read smoothly between pixels.
  void bindForDisplay() const;
  /// Sums of radiance and alpha, four floats a pixel. To be divided by the samples.
  std::vector<float> radianceSums() const;
  /// Sums of the third target, four floats a pixel: weighted depth, its weight, densities read, rays cut
  /// short.
  std::vector<float> depthSums() const;
  /// World distance from the camera to the medium seen in one pixel; 0 where none of it is.
  double depthAt(int x, int y) const;
  /// Reads the sums back; pixels without samples are 0. One target at a time, so that memory stays small.
  FilmPicture read() const;

  int width() const { return width_; }
  int height() const { return height_; }
  uint64_t gpuBytes() const { return bytesFor(width_, height_); }
  static uint64_t bytesFor(int width, int height);

 private:
  static constexpr int kTargets = 3;
  int width_;
  int height_;
  std::array<GlTexture, kTargets> textures_;
  GlFramebuffer framebuffer_;
};

}  // namespace nephele
