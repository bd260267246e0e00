// Where in its pixel each sample lies: a low-discrepancy sequence, so that means converge to the box
// filter's. Depends on shaders/shared alone.
#pragma once

#include <glm/vec2.hpp>

namespace nephele {

/// Sample `number`'s place in the pixel, in [0, 1)²: the additive recurrence frac(r + n · (1/p, 1/p²)) with p
/// the real root of p³ = p + 1 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018),
/// shifted by a random r that follows from `seed`. The same for all pixels, computed in double precision.
glm::vec2 subPixelOffset(unsigned number, unsigned seed);

}  // namespace nephele
