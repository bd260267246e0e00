// Cellular noise by SIMD, on lattice blocks and at points, with run-time dispatch and equal bits on every
// target. Depends on field.h and turn.h; Highway stays behind.
#pragma once

#include <cstdint>

#include "bake/fields/field.h"
#include "bake/fields/turn.h"

namespace nephele {

enum class WorleyOutput { f1, f2, f2MinusF1 };

struct WorleyNoise {
  double cellSize = 1.0;  // world units
  float jitter = 1.0f;    // 0: feature points at cell centres; 1: anywhere in their cells
  uint32_t seed = 0;
  int period = 0;  // cells; 0: none
  WorleyOutput output = WorleyOutput::f1;
  Turn turn{};
};

/// Distances in cells, ordered as the block; at most 4e-6 from shared::movingDistances.
void worleyOnLattice(const WorleyNoise& noise, const Lattice& lattice, float* values);

/// Distances in cells at each point; at most 4e-6 from shared::movingDistances.
void worleyAtPoints(const WorleyNoise& noise, const Points& points, float* values);

/// The definition at one place, in world units.
float worleyAt(const WorleyNoise& noise, const glm::dvec3& p);

}  // namespace nephele
