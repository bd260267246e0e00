// A picture's sums while it is sampled: means, independent halves, and how sure they are. Depends on
// base/picture.h.
#pragma once

#include <cstdint>
#include <vector>

#include "base/picture.h"

namespace nephele::truth {

/// What one block of samples gave for one pixel, as means over the block.
struct BlockMean {
  float radiance[3] = {0.0f, 0.0f, 0.0f};
  float transmittance[3] = {1.0f, 1.0f, 1.0f};
  float taken = 0.0f;          // weight of the distances
  float takenDistance = 0.0f;  // weighted distances
};

/// Sums of blocks, pixel by pixel. Blocks of a pixel are independent of each other; even ones make the first
/// half, odd ones the second. Pixels may have different numbers of them, and different pixels may be added to
/// from different threads.
class Estimate {
 public:
  Estimate(int width, int height);

  void add(size_t pixel, const BlockMean& mean);
  unsigned blocksOf(size_t pixel) const { return sums_[pixel].blocks; }
  /// √(mean over pixels of the variance of the mean)/mean radiance, averaged over channels, over the pixels
  /// whose alpha exceeds 1e-3: the noise of the picture in terms of relative RMSE. Infinite where a pixel has
  /// fewer than two blocks; 0 for a black picture.
  double relativeError() const { return errorOf(false); }
  /// What the picture's relative RMSE is below with a probability of 97.5%: the squared error of a picture is
  /// a sum over pixels that scatters about the variances' sum, and that sum is estimated from few blocks. A
  /// few bright pixels that make most of the noise make it wide.
  double relativeErrorBound() const { return errorOf(true); }
  /// Of the blocks still to come, each pixel's share, 1 on average: in proportion to the noise of its
  /// neighbours, which makes the most of them for the picture's error (Neyman 1934), and at least `least`.
  /// The pixel itself has no say: its mean would err where what it holds decided how much more it gets.
  std::vector<float> shares(float least) const;
  /// The picture with the planes of Method::render, then half1.R/G/B and half2.R/G/B (the means of the
  /// halves; absent where a pixel has fewer than two blocks) and interval.R/G/B: half of the width of the 95%
  /// confidence interval of R, G and B by Student's distribution over the blocks.
  Picture picture() const;

 private:
  struct Sums {
    float half[2][3] = {};
    float squares[3] = {};  // of deviations from the running mean (Welford)
    float mean[3] = {};
    float transmittance[3] = {};
    float taken = 0.0f, takenDistance = 0.0f;
    unsigned blocks = 0;
  };
  static bool isSeen(const Sums& sums);
  bool isHalved() const;
  double errorOf(bool bound) const;
  /// Of one block of each pixel, relative to the picture's mean; 0 where nothing is seen.
  std::vector<double> blockVariances() const;

  int width_, height_;
  std::vector<Sums> sums_;
};

/// The 97.5% quantile of Student's distribution with `freedom` ≥ 1 degrees: exact for 1 and 2, within 0.3%
/// else (Cornish and Fisher's expansion).
double studentQuantile(unsigned freedom);

}  // namespace nephele::truth
