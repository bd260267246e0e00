// The integrators' map: nothing grows at any step, drag and vortices are exact at all of them.
#include "particles/integrator_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nephele::test {
namespace {

const std::vector<IntegratorRow>& rows() {
  static const std::vector<IntegratorRow> all = integratorMap();
  return all;
}

TEST(IntegratorMap, NothingGrowsAtAnyStep) {
  for (const IntegratorRow& row : rows())
    EXPECT_NE(int(row.verdict), int(IntegratorVerdict::grows))
        << row.axis << ' ' << row.strength << " step " << row.stepSeconds << " error "
        << row.error.value_or(-1.0);
}

TEST(IntegratorMap, DragAndVorticesAreExactAtEveryStep) {
  int seen = 0;
  for (const IntegratorRow& row : rows()) {
    if (row.axis != "drag, 1/s" && row.axis != "vortex, radians per second") continue;
    ++seen;
    EXPECT_EQ(int(row.verdict), int(IntegratorVerdict::trusted)) << row.axis << ' ' << row.strength;
    // The rounding of places alone.
    EXPECT_LT(row.error.value_or(1.0), 5e-4) << row.axis << ' ' << row.strength << ' ' << row.stepSeconds;
  }
  EXPECT_EQ(seen, 40);
}

TEST(IntegratorMap, ShorterStepsAreNearerToTruth) {
  for (size_t n = 0; n + 4 < rows().size(); n += 5) {
    const IntegratorRow &shortest = rows()[n], &longest = rows()[n + 4];
    if (!shortest.error || !longest.error || *longest.error < kTrustedIntegratorError) continue;
    EXPECT_LT(*shortest.error, *longest.error) << shortest.axis << ' ' << shortest.strength;
  }
}

TEST(IntegratorMap, WhatRunsAwayIsRefusedWithItsPlace) {
  int refused = 0;
  for (const IntegratorRow& row : rows()) {
    if (row.verdict != IntegratorVerdict::refused) continue;
    ++refused;
    EXPECT_NE(row.sentence.find("places are kept within"), std::string::npos) << row.sentence;
  }
  EXPECT_EQ(refused, 5);
}

}  // namespace
}  // namespace nephele::test
