// What a leaf of 512 values goes through before it is stored, in one pass of SIMD with run-time dispatch.
// Every target gives equal bits. Depends on nothing; Highway stays behind.
#pragma once

#include <cstdint>

namespace nephele {

/// How a leaf's values are cut and rounded.
struct LeafRules {
  float cutoff = 0.0f;  // values at or below become 0 and inactive
  float limit = 0.0f;   // values above cannot be stored
  bool half = false;    // round to half precision, ties to even; what then is 0 becomes inactive
  float step = 0.0f;    // before that, round to multiples of this power of two, ties to even; 0: do not
};

struct LeafScan {
  uint64_t mask[8] = {};  // active values, bit n of word n / 64
  bool active = false;    // whether there is any
  bool storable = true;   // no value is NaN, infinite or above the limit; else the rest means nothing
  double mass = 0.0;      // Σ of values, each of 16 lanes summed in float
  float maximum = 0.0f;
};

/// Cuts and rounds values[512] in place and says what is left of them. With a step, a value below it becomes
/// a power of two instead, so that none becomes 0; none is rounded up beyond the limit.
LeafScan scanLeaf(const LeafRules& rules, float* values);

}  // namespace nephele
