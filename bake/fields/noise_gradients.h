// The gradients at lattice points as a table, for kernels. Depends on nothing.
#pragma once

namespace nephele {

/// The 16 gradients of shared::gradientDot, aligned for the widest vector.
alignas(64) inline constexpr float kGradientX[16] = {1, -1, 1, -1, 1, -1, 1, -1, 0, 0, 0, 0, 1, 0, -1, 0};
alignas(64) inline constexpr float kGradientY[16] = {1, 1, -1, -1, 0, 0, 0, 0, 1, -1, 1, -1, 1, -1, 1, -1};
alignas(64) inline constexpr float kGradientZ[16] = {0, 0, 0, 0, 1, 1, -1, -1, 1, 1, -1, -1, 0, 1, 0, -1};

}  // namespace nephele
