// Steps of stored densities: powers of two, whose multiples halves hold and compressors find again. Depends
// on half.h.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/half.h"

namespace nephele {

/// The least step is the least half's; the greatest the largest power of two that a half holds.
inline constexpr double kLeastDensityStep = double{kLeastHalf}, kGreatestDensityStep = 0x1p15;

inline bool isDensityStep(double step) {
  int exponent = 0;
  return step >= kLeastDensityStep && step <= kGreatestDensityStep && std::frexp(step, &exponent) == 0.5;
}

/// The largest step that cuts densities from 0 to `largest`, above 0, into at least `levels` of them, as far
/// as there is one.
inline double densityStepFor(double largest, double levels) {
  return std::clamp(std::exp2(std::floor(std::log2(largest / levels))), kLeastDensityStep,
                    kGreatestDensityStep);
}

}  // namespace nephele
