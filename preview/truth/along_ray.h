// What all tracking along one ray holds. Depends on preview/truth/channels.h, looks.h and tracking.h.
#pragma once

#include "preview/truth/channels.h"
#include "preview/truth/looks.h"
#include "preview/truth/tracking.h"

namespace nephele::truth {

/// A ray through a medium with its random numbers, counting the densities that are looked at. `Value` as
/// channels.h has it. What is passed in outlives it.
template <class Value>
struct AlongRay {
  AlongRay(const TrackedMedium& trackedMedium, const TrackedRay& trackedRay, Random& numbers,
           uint64_t& counter)
      : medium(trackedMedium),
        ray(trackedRay),
        random(numbers),
        looks(counter),
        sigma(extinction<Value>(trackedMedium)),
        clock(numbers) {}

  float densityAt(const ControlCell& cell, float t) {
    ++looks;
    return densityIn(medium, cell, ray.origin + t * ray.direction);
  }
  /// What the density has beyond the control, over the rate of looks.
  float excessAt(const ControlCell& cell, float t) {
    return (densityAt(cell, t) - cell.control) / cell.residual;
  }

  const TrackedMedium& medium;
  const TrackedRay& ray;
  Random& random;
  uint64_t& looks;
  Value sigma;
  LookClock clock;
};

}  // namespace nephele::truth
