// Two pictures held against each other: relative RMSE, bias and tails (DESIGN.md, section 1). Depends on
// base.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/picture.h"
#include "base/tolerance.h"

namespace nephele {

/// Whether a picture holds the planes half1.R … half2.B: two independent estimates of R, G and B.
bool hasHalves(const Picture& picture);

/// Indices of the pixels that are compared: where either alpha exceeds 1e-3, all where a picture has no
/// alpha.
std::vector<size_t> seenPixels(const Picture& a, const Picture& b);

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

/// Where the reference holds two halves, its noise is taken out of relativeRmse as compareWithHalves does.
/// Throws InputError where sizes differ, R, G or B is missing, or a value is not finite; the names are for
/// sentences.
Comparison comparePictures(const Picture& picture, const std::string& pictureName, const Picture& reference,
                           const std::string& referenceName);

/// A relative RMSE against a noisy reference, with its 95% confidence interval (over pixels, as if each were
/// independent).
struct NoisyError {
  double relativeRmse = 0.0;  // the root of the square below where that is positive, else 0
  double low = 0.0, high = 0.0;
  double bias = 0.0;
  double p99 = 0.0;  // against the halves' mean: the reference's noise is in it
};

/// As comparePictures against a reference of two independent halves (planes half1.R … half2.B): the square is
/// (x − r1)(x − r2), in which the reference's noise cancels; the mean is that of both halves. Throws
/// InputError where sizes differ or a plane is missing.
NoisyError compareWithHalves(const Picture& picture, const Picture& reference);

/// "relative RMSE 1.2%, …" in one line; or JSON with the keys pixels, relative_rmse, bias, p99, max.
std::string comparisonAsText(const Comparison& comparison);
std::string comparisonAsJson(const Comparison& comparison);

}  // namespace nephele
