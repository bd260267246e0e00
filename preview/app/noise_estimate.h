// How noisy a picture still is, from two halves of its samples. Depends on nothing.
#pragma once

#include <span>

namespace nephele {

/// Relative noise of the mean over `count` samples: half the difference of the means of two halves has the
/// same variance as the mean of all. `firstHalf` holds sums over the first count/2 samples, `all` over all of
/// them: four floats a pixel, R, G, B, alpha; of equal length; count even and above 0. As relative RMSE is
/// defined (DESIGN.md, section 1): √(mean d²)/mean over the pixels whose alpha exceeds 1e-3, per channel,
/// then averaged over the channels that hold any light. 0 where there is none. Thread-safe.
double relativeNoise(std::span<const float> firstHalf, std::span<const float> all, unsigned count);

/// Samples that would bring `noise`, found at `count`, down to `tolerance` > 0 where it falls as 1/√n; at
/// most `most`, at least `count`.
unsigned samplesFor(double noise, unsigned count, double tolerance, unsigned most);

}  // namespace nephele
