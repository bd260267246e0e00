// Sums of blocks and their confidence. Depends on base/picture.h.
#include "preview/truth/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace nephele::truth {

namespace {
constexpr float kThird = 1.0f / 3.0f;
constexpr double kNormal = 1.959963984540054;  // the 97.5% quantile of the normal distribution

/// Of each pixel's up to eight neighbours, the pixel left out; 0 where there is none.
std::vector<double> meanAround(const std::vector<double>& values, int width, int height) {
  const auto at = [width](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  std::vector<double> means(values.size(), 0.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = -values[at(x, y)], count = -1.0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
          sum += values[at(i, j)];
          count += 1.0;
        }
      // What is left of a difference may be below 0 by rounding.
      if (count > 0.0) means[at(x, y)] = std::max(sum, 0.0) / count;
    }
  return means;
}

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

void Estimate::add(size_t pixel, const BlockMean& mean) {
  Sums& s = sums_[pixel];
  const unsigned half = s.blocks++ % 2;
  for (int c = 0; c < 3; ++c) {
    s.half[half][c] += mean.radiance[c];
    const float before = mean.radiance[c] - s.mean[c];
    s.mean[c] += before / static_cast<float>(s.blocks);
    s.squares[c] += before * (mean.radiance[c] - s.mean[c]);
    s.transmittance[c] += mean.transmittance[c];
  }
  s.taken += mean.taken;
  s.takenDistance += mean.takenDistance;
}

bool Estimate::isSeen(const Sums& s) {
  constexpr double kSeen = 1e-3;
  const double through = double{s.transmittance[0] + s.transmittance[1] + s.transmittance[2]};
  return 1.0 - through / (3.0 * s.blocks) > kSeen;
}

bool Estimate::isHalved() const {
  return std::all_of(sums_.begin(), sums_.end(), [](const Sums& s) { return s.blocks >= 2; });
}

double Estimate::errorOf(bool bound) const {
  if (!isHalved()) return std::numeric_limits<double>::infinity();
  double variance[3] = {}, scatter[3] = {}, sum[3] = {}, seen = 0.0;
  for (const Sums& s : sums_) {
    if (!isSeen(s)) continue;
    seen += 1.0;
    const double count = s.blocks;
    for (int c = 0; c < 3; ++c) {
      const double one = double{s.squares[c]} / (count * (count - 1.0));
      variance[c] += one;
      // Of the squared error's scatter, 2 variance², and of the estimate's, the same over blocks − 1.
      scatter[c] += 2.0 * one * one * count / (count - 1.0);
      sum[c] += double{s.mean[c]};
    }
  }
  double error = 0.0;
  for (int c = 0; c < 3; ++c) {
    if (!(sum[c] > 0.0)) continue;
    const double above = bound ? kNormal * std::sqrt(scatter[c]) : 0.0;
    error += std::sqrt((variance[c] + above) * seen) / sum[c] / 3.0;
  }
  return error;
}

std::vector<double> Estimate::blockVariances() const {
  double sum[3] = {};
  for (const Sums& s : sums_)
    for (int c = 0; c < 3; ++c)
      if (isSeen(s)) sum[c] += double{s.mean[c]};
  std::vector<double> variances(sums_.size(), 0.0);
  for (size_t i = 0; i < sums_.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (sum[c] > 0.0 && isSeen(sums_[i]))
        variances[i] += double{sums_[i].squares[c]} / (sums_[i].blocks - 1.0) / (sum[c] * sum[c]);
  return variances;
}

std::vector<float> Estimate::shares(float least) const {
  const std::vector<double> around = meanAround(blockVariances(), width_, height_);
  std::vector<float> shares(sums_.size(), 1.0f);
  double mean = 0.0;
  for (const double variance : around) mean += std::sqrt(variance) / static_cast<double>(sums_.size());
  if (!isHalved() || !(mean > 0.0)) return shares;
  for (size_t i = 0; i < shares.size(); ++i)
    shares[i] = least + (1.0f - least) * static_cast<float>(std::sqrt(around[i]) / mean);
  return shares;
}

Picture Estimate::picture() const {
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
  const bool halved = isHalved();
  const size_t half1 = halved ? addThree("half1.") : 0, half2 = halved ? addThree("half2.") : 0,
               interval = halved ? addThree("interval.") : 0;
  for (size_t i = 0; i < sums_.size(); ++i) {
    const Sums& s = sums_[i];
    const float all = static_cast<float>(s.blocks);
    const float firstHalf = static_cast<float>((s.blocks + 1) / 2),
                secondHalf = static_cast<float>(s.blocks / 2);
    const double count = s.blocks, width = halved ? studentQuantile(s.blocks - 1) : 0.0;
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
