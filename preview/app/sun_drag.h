// The sun as a hand turns it. Depends on scene's vectors alone.
#pragma once

#include <glm/vec3.hpp>

namespace nephele {

/// The direction to the sun after a drag by (right, down), in window heights: a height is half a turn about
/// `up`, and half a turn of elevation, which stops at the zenith and its opposite. The lit side of what is
/// seen follows the hand: a sun behind the camera moves with it. Of unit length; `toLight` and `up` are not
/// 0.
glm::dvec3 dragSun(const glm::dvec3& toLight, const glm::dvec3& up, double right, double down);

}  // namespace nephele
