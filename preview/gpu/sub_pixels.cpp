// The sub-pixel sequence. Depends on shaders/shared alone.
#include "preview/gpu/sub_pixels.h"

#include "shaders/shared/leaves.h"

namespace nephele {
glm::vec2 subPixelOffset(unsigned number, unsigned seed) {
  constexpr unsigned kPurpose = 0x5ab91e77u;  // sets this use of the seed apart from the march's
  return shared::evenPlace(number, shared::hashBits(seed ^ kPurpose));
}

}  // namespace nephele
