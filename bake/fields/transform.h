// Where a transform puts its input. Depends on table.h.
#pragma once

#include <glm/mat3x3.hpp>

#include "bake/fields/table.h"

namespace nephele {

/// world = worldFromLocal · local + offset, and back. Columns of a matrix are the images of the axes.
struct Placement {
  glm::dmat3 worldFromLocal{1.0}, localFromWorld{1.0};
  glm::dvec3 offset{0.0};
  double leastScale = 1.0;  // along any axis
};

/// The placement of a transform row's arguments at the context's time: scaled along the axes of its input,
/// turned about x, then y, then z, about `center`; then moved by `translate` and `scroll` · time.
Placement placementOf(const Arguments& arguments, const BuildContext& context);

/// The input, placed.
FieldPtr placedField(FieldPtr input, const Placement& placement);

}  // namespace nephele
