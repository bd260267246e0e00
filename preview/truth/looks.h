// When a tracked ray looks at the true density, and when it ends by chance. Depends on
// preview/truth/random.h.
#pragma once

#include "preview/truth/random.h"

namespace nephele::truth {

/// A Poisson process along a ray whose rate changes from piece to piece.
class LookClock {
 public:
  explicit LookClock(Random& random) : toLook_(random.exponential()) {}

  /// Calls look(t) for each event in [t0, t1] at `rate` per unit of t, in order.
  template <class Look>
  void cross(float rate, float t0, float t1, Random& random, Look&& look) {
    float ahead = rate * (t1 - t0);  // events expected in what is left of the piece
    while (toLook_ < ahead) {
      ahead -= toLook_;
      look(t1 - ahead / rate);
      toLook_ = random.exponential();
    }
    toLook_ -= ahead;
  }

 private:
  float toLook_;
};

/// Russian roulette on a ray of which `through` (largest channel) is left: below kLeast one goes on in
/// proportion and then counts as kLeast. Returns the factor to count it by: 1 above, 0 where it ends.
inline float roulette(float through, Random& random) {
  constexpr float kLeast = 0.02f;  // small beside what other rays bring
  if (through >= kLeast) return 1.0f;
  return random.uniform() * kLeast < through ? kLeast / through : 0.0f;
}

}  // namespace nephele::truth
