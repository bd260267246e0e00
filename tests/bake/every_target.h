// Runs a computation on every SIMD target of this machine and holds the results to equal bits.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace nephele::test {

/// `compute` returns the same floats on every target, or the test fails naming the target. Says which were
/// compared.
inline void expectEqualBitsOnEveryTarget(const std::function<std::vector<float>()>& compute) {
  std::vector<float> expected;
  std::string names;
  int targets = 0;
  for (int64_t bits = hwy::SupportedTargets() & HWY_TARGETS; bits != 0; bits &= bits - 1) {
    const int64_t target = bits & -bits;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<float> values = compute();
    if (expected.empty()) expected = values;
    EXPECT_EQ(expected.size(), values.size());
    EXPECT_EQ(std::memcmp(expected.data(), values.data(), values.size() * sizeof(float)), 0)
        << hwy::TargetName(target);
    names += std::string(" ") + hwy::TargetName(target);
    ++targets;
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  std::printf("compared targets:%s\n", names.c_str());
  EXPECT_GE(targets, 2) << "only one target on this machine: nothing was compared";
}

}  // namespace nephele::test
