// diff against closed forms: a box that is doubled, moved, resampled.
#include "volume/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>

namespace nephele::test {
namespace {

/// A cube of 20³ samples of `value`, voxels of side `side`, at index `origin`.
BrickVolume cube(float value, double side, const glm::ivec3& origin = glm::ivec3(0)) {
  return bricksFromDense(std::vector<float>(20 * 20 * 20, value), glm::ivec3(20), origin,
                         glm::scale(glm::dmat4(1.0), glm::dvec3(side)));
}

TEST(Difference, OfAGridAndItselfIsNothing) {
  const GridDifference d = difference(cube(0.7f, 0.1), cube(0.7f, 0.1), 500);
  EXPECT_EQ(d.largest, 0.0);
  EXPECT_EQ(d.largestDepth, 0.0);
  EXPECT_EQ(d.voxelsBoth, 8000u);
  EXPECT_EQ(d.voxelsOnlyA + d.voxelsOnlyB, 0u);
  EXPECT_GT(d.largestDepthA, 0.0);
}

TEST(Difference, OfADoubledGridIsTheGrid) {
  const GridDifference d = difference(cube(0.5f, 0.1), cube(1.0f, 0.1), 500);
  EXPECT_DOUBLE_EQ(d.largest, 0.5);
  EXPECT_DOUBLE_EQ(d.rms, 0.5);
  EXPECT_DOUBLE_EQ(d.meanA, 0.5);
  EXPECT_DOUBLE_EQ(d.relativeRmse(), 1.0);
  EXPECT_DOUBLE_EQ(d.relativeDensity(), 1.0);
  EXPECT_NEAR(d.relativeDepth(), 1.0, 1e-12);
}

TEST(Difference, CountsWhatOnlyOneHolds) {
  const GridDifference d = difference(cube(1.0f, 0.1), cube(1.0f, 0.1, {5, 0, 0}), 100);
  EXPECT_EQ(d.voxelsBoth, 15u * 400u);
  EXPECT_EQ(d.voxelsOnlyA, 5u * 400u);
  EXPECT_EQ(d.voxelsOnlyB, 5u * 400u);
  EXPECT_DOUBLE_EQ(d.meanA, 0.8);  // over the samples of either
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(0.4));
  EXPECT_DOUBLE_EQ(d.largest, 1.0);
}

TEST(Difference, OfAnEmptyGridIsJudgedRightly) {
  const BrickVolume empty = cube(0.0f, 0.1);
  EXPECT_EQ(difference(empty, empty, 50).relativeDensity(), 0.0);
  EXPECT_TRUE(std::isinf(difference(empty, cube(1.0f, 0.1), 50).relativeDensity()));
  EXPECT_DOUBLE_EQ(difference(cube(1.0f, 0.1), empty, 50).relativeDepth(), 1.0);
}

TEST(Difference, ReadsOtherTransformsBetweenSamples) {
  // The same ramp along x on two lattices: trilinear reading is exact on it up to the last samples at 4; a
  // quarter beyond, where the finer grid has reached 0, the coarser still holds half of its largest value, 5.
  const auto ramp = [](double side, int count) {
    std::vector<float> values;
    for (int z = 0; z < count; ++z)
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) values.push_back(float(1.0 + x * side));
    return bricksFromDense(values, glm::ivec3(count), glm::ivec3(0),
                           glm::scale(glm::dmat4(1.0), glm::dvec3(side)));
  };
  const BrickVolume coarse = ramp(0.5, 9), fine = ramp(0.25, 17);
  const GridDifference d = difference(coarse, fine, 200);
  EXPECT_FALSE(d.sameTransform);
  EXPECT_NEAR(d.largest, 2.5, 1e-6);
  EXPECT_GT(d.largestDepth, 0.0) << "the borders reach half as far on the finer grid";
}

}  // namespace
}  // namespace nephele::test
