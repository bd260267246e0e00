// The method `reference`: pictures by the path tracer. Depends on preview/method.h.
#pragma once

#include <memory>

#include "preview/method.h"

namespace nephele {

/// Unbiased pictures on the CPU, on all threads; equal requests give equal pictures on any number of them.
/// Physical terms alone: octaves, powder and the chord are not looked at. Beside the planes of Method::render
/// a picture holds half1.R/G/B and half2.R/G/B, two independent estimates whose mean it is, and
/// interval.R/G/B, half the width of each pixel's 95% confidence interval.
std::unique_ptr<Method> makeReferenceMethod(const MethodOptions& options);

}  // namespace nephele
