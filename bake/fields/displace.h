// Places of a lattice block moved by what a noise says, by SIMD with run-time dispatch. Depends on field.h;
// Highway stays behind.
#pragma once

#include "bake/fields/field.h"

namespace nephele {

/// shift[axis][n] becomes the block's n-th offset from its origin along the axis + scale · shift[axis][n]:
/// the same floats as at LatticePoints. Three times 512 floats.
void displaceOnLattice(const Lattice& lattice, float scale, float shift[3][kBlockPoints]);

}  // namespace nephele
