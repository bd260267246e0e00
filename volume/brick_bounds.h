// Codes of a brick's bounds, as words of the index hold them: read alike by shaders (shared/walk.glsl) and
// C++. Depends on nothing of ours.
#pragma once

#include <bit>
#include <cstdint>

namespace nephele::brick_bounds {

/// Codes of maxima are small floats, 5 bits of exponent and 3 of mantissa: kOne stands for the volume's
/// maximum, 1 for the least bound, 2^-31 of it; 0 for no density at all.
inline constexpr uint32_t kOne = 248;
/// Minima are kept as shares of the maximum, in 255ths.
inline constexpr uint32_t kShareOne = 255;

/// What `code`, 1 … kOne, stands for.
inline float bound(uint32_t code, float maximum) {
  // The code's bits lie below a float's exponent and at the top of its mantissa.
  constexpr uint32_t kMantissaShift = 20, kExponentShift = 23, kOffset = 127u - 31u;
  return maximum * std::bit_cast<float>((code << kMantissaShift) + (kOffset << kExponentShift));
}

/// The least code whose bound `value`, from 0 to `maximum`, does not exceed; 0 for 0.
inline uint32_t codeFor(float value, float maximum) {
  if (!(value > 0.0f)) return 0;
  uint32_t least = 1, most = kOne;
  while (least < most) {
    const uint32_t middle = (least + most) / 2;
    if (value <= bound(middle, maximum))
      most = middle;
    else
      least = middle + 1;
  }
  return least;
}

/// The largest share, in 255ths, of `maximum` that `minimum` reaches.
inline uint32_t shareFor(float minimum, float maximum) {
  if (!(maximum > 0.0f)) return 0;
  uint32_t share = static_cast<uint32_t>(minimum / maximum * static_cast<float>(kShareOne));
  // As the shaders compute it, and compared with that.
  while (share > 0 && minimum < maximum * (static_cast<float>(share) / static_cast<float>(kShareOne)))
    --share;
  return share;
}

}  // namespace nephele::brick_bounds
