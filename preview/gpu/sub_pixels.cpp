// The sub-pixel sequence. Depends on shaders/shared alone.
#include "preview/gpu/sub_pixels.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/leaves.h"

namespace nephele {
namespace {

constexpr double kPlasticNumber = 1.32471795724474602596;  // the real root of p³ = p + 1

float wrapped(double value) {
  // The largest float below 1: rounding must not reach the next pixel.
  constexpr float kBelowOne = 0x1.fffffep-1f;
  return std::min(static_cast<float>(value - std::floor(value)), kBelowOne);
}

}  // namespace

glm::vec2 subPixelOffset(unsigned number, unsigned seed) {
  constexpr unsigned kPurpose = 0x5ab91e77u;  // sets this use of the seed apart from the march's
  unsigned state = shared::randomState(0u, 0u, kPurpose, seed);
  const double rotationX = double{shared::nextUniform(state)};
  const double rotationY = double{shared::nextUniform(state)};
  return glm::vec2(wrapped(rotationX + number / kPlasticNumber),
                   wrapped(rotationY + number / (kPlasticNumber * kPlasticNumber)));
}

}  // namespace nephele
