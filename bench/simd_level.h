// Forces one SIMD level on our kernels. Depends on Highway.
#pragma once

#include <hwy/targets.h>

namespace nephele::bench {

/// While it lives, our kernels run the given Highway target and no other; afterwards the machine's best.
class SimdLevel {
 public:
  explicit SimdLevel(int64_t target) { force(target); }
  ~SimdLevel() { force(0); }
  SimdLevel(const SimdLevel&) = delete;
  SimdLevel& operator=(const SimdLevel&) = delete;

 private:
  static void force(int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace nephele::bench
