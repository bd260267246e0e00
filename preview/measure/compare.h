// Two pictures held against each other: relative RMSE, bias and tails (DESIGN.md, section 1). Depends on
// base.
#pragma once

#include <cstdint>
#include <string>

#include "base/picture.h"
#include "base/tolerance.h"

namespace nephele {

/// Errors of a picture x against a reference r over the pixels where either alpha exceeds 1e-3 (all pixels
/// where a picture has no alpha), of R, G and B. Relative figures are infinite where r is black and x is not,
/// 0 where both are black.
struct Comparison {
  uint64_t pixels = 0;        // that were compared
  double relativeRmse = 0.0;  // √(mean (x − r)²)/mean r, averaged over channels
  double bias = 0.0;          // mean (x − r)/mean r, averaged over channels
  double p99 = 0.0;  // 99th percentile of |x − r|/max(|x|, |r|, 1e-3 of r's maximum) over pixels and channels
  double maximum = 0.0;  // its largest value
};

/// Throws InputError where sizes differ, R, G or B is missing, or a value is not finite; the names are for
/// sentences.
Comparison comparePictures(const Picture& picture, const std::string& pictureName, const Picture& reference,
                           const std::string& referenceName);

/// "relative RMSE 1.2%, …" in one line; or JSON with the keys pixels, relative_rmse, bias, p99, max.
std::string comparisonAsText(const Comparison& comparison);
std::string comparisonAsJson(const Comparison& comparison);

}  // namespace nephele
