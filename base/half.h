// The ends of half precision, which files may store values in. Depends on nothing.
#pragma once

namespace nephele {

/// The largest finite half, and the least above 0.
inline constexpr float kLargestHalf = 65504.0f, kLeastHalf = 0x1p-24f;

}  // namespace nephele
