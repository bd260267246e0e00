// Degrees of files to radians of the program. Depends on nothing.
#pragma once

#include <numbers>

namespace nephele {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

}  // namespace nephele
