// How samples of bricks are kept on the GPU: 8 bits with a scale a brick, halves or floats, and which of them
// a volume allows. Depends on volume/bricks.h alone; no OpenVDB and no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "volume/bricks.h"

namespace nephele {

/// r8: 255 even steps from 0 to the brick's bound; r16f: halves, 11 bits; r32f: as read.
enum class Texel { r8, r16f, r32f };

/// Bytes of a sample.
size_t bytesOf(Texel texel);
/// "r8", "r16f", "r32f".
std::string_view nameOf(Texel texel);

/// Nearest half, ties to even; infinity from 65520 on. `value` is finite and at least 0.
uint16_t halfOf(float value);
/// The value of a half of at least 0, exactly.
float fromHalf(uint16_t half);

/// Nearest of the 255 steps from 0 to `scale`, which `value` does not exceed; 0 for a scale of 0.
uint8_t byteOf(float value, float scale);

/// What `value`, from 0 to `scale`, becomes when kept as `texel`; `scale` is looked at for r8 alone.
float keptAs(Texel texel, float value, float scale);

/// A bound of what r8 or r16f may change in the optical depth of any ray, as a share of the larger of its own
/// and the largest along an axis: for halves 2^-11 (0 where all are exact); and for the rest of each sample's
/// error the sum over the layers of bricks along an axis of the layer's worst, times the longest way through
/// a layer. 0 for r32f; infinite where values leave a half's range. Takes a pass over all samples, on all
/// threads.
double texelError(const BrickVolume& volume, Texel texel);

/// The largest texelError that is taken for nothing: a quarter of the least step of an 8-bit picture.
inline constexpr double kTexelError = 1e-3;

/// The smallest texel whose texelError is at most kTexelError.
Texel chooseTexel(const BrickVolume& volume);

}  // namespace nephele
