// The table of hard cases on the GPU: no bad value anywhere, and the middle of each axis within its bound.
#include <gtest/gtest.h>

#include "preview/measure/stability_page.h"

namespace nephele {
namespace {

TEST(GlStability, NoMethodHoldsABadValueAnywhere) {
  StabilityOptions options;
  for (const MethodRow& row : methods())
    if (row.make != nullptr) options.methods.push_back(row);
  options.size = 16;
  options.samples = 4;
  options.truthSamples = 8;
  options.frames = 3;
  options.quiet = true;
  const StabilityResult result = runStability(options);
  for (const std::string& sentence : badCells(result)) ADD_FAILURE() << sentence;
  EXPECT_GT(result.cells.size(), 200u);
  for (const Flicker& flicker : result.flicker) EXPECT_TRUE(std::isfinite(flicker.error)) << flicker.motion;
}

}  // namespace
}  // namespace nephele
