// Where in its pixel each sample lies: a low-discrepancy sequence, so that means converge to the box
// filter's. Depends on shaders/shared alone.
#pragma once

#include <glm/vec2.hpp>

namespace nephele {

/// Sample `number`'s place in the pixel, in [0, 1)²: evenPlace of shaders/shared/random.glsl, scrambled by
/// what follows from `seed`, the first in the pixel's middle: one sample of its own is nearest to the mean
/// there. The same for all pixels.
glm::vec2 subPixelOffset(unsigned number, unsigned seed);

}  // namespace nephele
