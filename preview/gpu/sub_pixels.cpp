// The sub-pixel sequence. Depends on shaders/shared alone.
#include "preview/gpu/sub_pixels.h"

#include <cmath>

#include "shaders/shared/leaves.h"

namespace nephele {

glm::vec2 subPixelOffset(unsigned number, unsigned seed) {
  constexpr unsigned kPurpose = 0x5ab91e77u;  // sets this use of the seed apart from the march's
  const unsigned scramble = shared::hashBits(seed ^ kPurpose);
  const glm::vec2 at = shared::evenPlace(number, scramble), first = shared::evenPlace(0, scramble);
  // One more change of digits, which leaves one place in each box, takes the first to the middle.
  constexpr int kDigits = 24;
  const auto moved = [](float place, float from) {
    const auto digits = [](float share) { return static_cast<unsigned>(std::ldexp(share, kDigits)); };
    return std::ldexp(static_cast<float>(digits(place) ^ digits(from) ^ digits(0.5f)), -kDigits);
  };
  return {moved(at.x, first.x), moved(at.y, first.y)};
}

}  // namespace nephele
