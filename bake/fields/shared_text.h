// The shared texts that fields are made of, compiled as C++. Depends on shaders/shared alone.
#pragma once

#include "shaders/shared/dialect.h"

namespace nephele::shared {
#include "shaders/shared/csg.glsl"
#include "shaders/shared/math.glsl"
#include "shaders/shared/noise.glsl"
#include "shaders/shared/ramps.glsl"
#include "shaders/shared/remap.glsl"
#include "shaders/shared/shapes.glsl"
#include "shaders/shared/weather.glsl"
}  // namespace nephele::shared
