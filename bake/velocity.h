// The velocity of an asset, for its grid `vel`: derived from the motion of its fields, or made of fields of
// its own. Depends on pipeline.
#pragma once

#include <memory>

#include "bake/pipeline.h"

namespace nephele {

/// Three values a point, world units per second. Immutable; any number of threads.
class VectorField {
 public:
  virtual ~VectorField() = default;
  /// x, y and z hold 512 floats each, ordered as the block.
  virtual void evaluate(const Lattice& lattice, float* x, float* y, float* z) const = 0;
};
using VectorFieldPtr = std::shared_ptr<const VectorField>;

/// The asset's velocity at the context's time; nullptr where it asks for none.
///
/// `velocity: true`: a noise moves with its scroll, one of many octaves with their mean; what neither scrolls
/// nor holds anything that does has no say. A field made of several that move takes their mean, weighted by
/// the magnitude of their values at the place (even where all are 0); a warp moves as its input does, or
/// where that rests as its own noise. Noise that evolves in place adds nothing. Where nothing moves the
/// velocity is 0. `velocity: FIELD` or three fields: those components.
VectorFieldPtr buildVelocity(const Asset& asset, const BuildContext& context);

}  // namespace nephele
