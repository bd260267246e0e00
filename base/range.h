// The numbers that a key or a parameter accepts. Depends on nothing.
#pragma once

#include <limits>

namespace nephele {

/// An interval of legal numbers. Ends are included unless open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool lowOpen = false;
  bool highOpen = false;
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range kNonNegative{0.0, std::numeric_limits<double>::infinity(), false, false};
inline constexpr Range kUnit{0.0, 1.0, false, false};

}  // namespace nephele
