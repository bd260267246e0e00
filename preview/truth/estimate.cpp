// Sums of blocks and their confidence. Depends on base/picture.h.
#include "preview/truth/estimate.h"

#include <cmath>
#include <limits>
#include <string>

namespace nephele::truth {

namespace {
constexpr float kThird = 1.0f / 3.0f;
constexpr double kNormal = 1.959963984540054;  // the 97.5% quantile of the normal distribution
}  // namespace

double studentQuantile(unsigned freedom) {
  constexpr double kOne = 12.706204736432095, kTwo = 4.302652729911275;
  if (freedom == 1) return kOne;
  if (freedom == 2) return kTwo;
  // Abramowitz and Stegun, 26.7.5.
  const double z = kNormal, n = freedom, z2 = z * z;
  const double g1 = z * (z2 + 1.0) / 4.0, g2 = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0,
               g3 = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0,
               g4 = z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return z + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

Estimate::Estimate(int width, int height)
    : width_(width), height_(height), sums_(static_cast<size_t>(width) * static_cast<size_t>(height)) {}

void Estimate::add(size_t pixel, unsigned block, const BlockMean& mean) {
  Sums& s = sums_[pixel];
  for (int c = 0; c < 3; ++c) {
    s.half[block % 2][c] += mean.radiance[c];
    const float before = mean.radiance[c] - s.mean[c];
    s.mean[c] += before / static_cast<float>(block + 1);
    s.squares[c] += before * (mean.radiance[c] - s.mean[c]);
    s.transmittance[c] += mean.transmittance[c];
  }
  s.taken += mean.taken;
  s.takenDistance += mean.takenDistance;
}

double Estimate::errorOf(unsigned blocks, bool bound) const {
  if (blocks < 2) return std::numeric_limits<double>::infinity();
  constexpr double kSeen = 1e-3;
  const double count = blocks;
  double variance[3] = {}, squares[3] = {}, sum[3] = {}, seen = 0.0;
  for (const Sums& s : sums_) {
    const double through =
        double{s.transmittance[0] + s.transmittance[1] + s.transmittance[2]} / (3.0 * blocks);
    if (!(1.0 - through > kSeen)) continue;
    seen += 1.0;
    for (int c = 0; c < 3; ++c) {
      const double one = double{s.squares[c]} / (count * (count - 1.0));
      variance[c] += one;
      squares[c] += one * one;
      sum[c] += double{s.mean[c]};
    }
  }
  double error = 0.0;
  for (int c = 0; c < 3; ++c) {
    if (!(sum[c] > 0.0)) continue;
    // Of the squared error's scatter, 2 Σ variance², and of the estimate's, the same over blocks − 1.
    const double above = bound ? kNormal * std::sqrt(2.0 * squares[c] * count / (count - 1.0)) : 0.0;
    error += std::sqrt((variance[c] + above) * seen) / sum[c] / 3.0;
  }
  return error;
}

Picture Estimate::picture(unsigned blocks) const {
  Picture picture;
  picture.width = width_;
  picture.height = height_;
  const auto addThree = [&](const std::string& prefix) {
    const size_t first = picture.add(prefix + "R");
    picture.add(prefix + "G");
    picture.add(prefix + "B");
    return first;
  };
  const size_t colour = addThree(""), alpha = picture.add("A"), through = addThree("transmittance."),
               depth = picture.add("depth");
  const bool halved = blocks >= 2;
  const size_t half1 = halved ? addThree("half1.") : 0, half2 = halved ? addThree("half2.") : 0,
               interval = halved ? addThree("interval.") : 0;
  const float all = static_cast<float>(blocks);
  const float firstHalf = static_cast<float>((blocks + 1) / 2), secondHalf = static_cast<float>(blocks / 2);
  const double count = blocks, width = halved ? studentQuantile(blocks - 1) : 0.0;
  for (size_t i = 0; i < sums_.size(); ++i) {
    const Sums& s = sums_[i];
    float mean = 0.0f;
    for (size_t c = 0; c < 3; ++c) {
      picture.planes[colour + c][i] = (s.half[0][c] + s.half[1][c]) / all;
      picture.planes[through + c][i] = s.transmittance[c] / all;
      mean += kThird * s.transmittance[c] / all;
      if (!halved) continue;
      picture.planes[half1 + c][i] = s.half[0][c] / firstHalf;
      picture.planes[half2 + c][i] = s.half[1][c] / secondHalf;
      const double variance = double{s.squares[c]} / (count * (count - 1.0));
      picture.planes[interval + c][i] = static_cast<float>(width * std::sqrt(std::max(variance, 0.0)));
    }
    picture.planes[alpha][i] = std::max(1.0f - mean, 0.0f);  // the mean may round to a hair above 1
    picture.planes[depth][i] = s.taken > 0.0f ? s.takenDistance / s.taken : 0.0f;
  }
  return picture;
}

}  // namespace nephele::truth
