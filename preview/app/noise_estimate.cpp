// Differences of halves. Depends on base alone.
#include "preview/app/noise_estimate.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace nephele {

double relativeNoise(std::span<const float> firstHalf, std::span<const float> all, unsigned count) {
  constexpr size_t kChannels = 4, kColours = 3, kAlpha = 3;
  constexpr double kLeastAlpha = 1e-3;
  NEPHELE_CHECK_EQ(firstHalf.size(), all.size());
  NEPHELE_CHECK_GT(count, 0u);
  NEPHELE_CHECK_EQ(count % 2, 0u);
  double squares[kColours] = {}, sums[kColours] = {};
  size_t pixels = 0;
  for (size_t i = 0; i + kAlpha < all.size(); i += kChannels) {
    if (double{all[i + kAlpha]} <= kLeastAlpha * count) continue;
    ++pixels;
    for (size_t c = 0; c < kColours; ++c) {
      // (mean of the first half − mean of the second) / 2, with second = all − first and halves of count/2.
      const double difference = (2.0 * double{firstHalf[i + c]} - double{all[i + c]}) / count;
      squares[c] += difference * difference;
      sums[c] += double{all[i + c]} / count;
    }
  }
  double noise = 0.0;
  int lit = 0;
  for (size_t c = 0; c < kColours; ++c) {
    if (!(sums[c] > 0.0)) continue;
    ++lit;
    noise += std::sqrt(squares[c] * static_cast<double>(pixels)) / sums[c];
  }
  return lit > 0 ? noise / lit : 0.0;
}

unsigned samplesFor(double noise, unsigned count, double tolerance, unsigned most) {
  NEPHELE_CHECK_GT(tolerance, 0.0);
  const double least = count, highest = std::max(least, static_cast<double>(most));
  const double ratio = noise / tolerance;
  return static_cast<unsigned>(std::clamp(std::ceil(least * ratio * ratio), least, highest));
}

}  // namespace nephele
