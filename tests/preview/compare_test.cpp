// Picture errors against closed forms, and the words that the commands read.
#include "preview/measure/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "preview/method.h"
#include "preview/render_command.h"

namespace nephele {
namespace {

Picture uniformPicture(float red, float green, float blue, float alpha) {
  Picture picture;
  picture.width = 4;
  picture.height = 2;
  for (const char* name : {"R", "G", "B", "A"}) picture.add(name);
  const float values[] = {red, green, blue, alpha};
  for (size_t c = 0; c < 4; ++c) picture.planes[c].assign(8, values[c]);
  return picture;
}

TEST(Compare, EqualPicturesHaveNoError) {
  const Picture p = uniformPicture(0.25f, 0.5f, 1.0f, 1.0f);
  const Comparison c = comparePictures(p, "a", p, "b");
  EXPECT_EQ(c.pixels, 8u);
  EXPECT_EQ(c.relativeRmse, 0.0);
  EXPECT_EQ(c.maximum, 0.0);
}

TEST(Compare, ConstantFactorIsRmseAndBias) {
  const Picture r = uniformPicture(0.25f, 0.5f, 1.0f, 1.0f);
  const Comparison c = comparePictures(uniformPicture(0.375f, 0.75f, 1.5f, 1.0f), "a", r, "b");
  EXPECT_NEAR(c.relativeRmse, 0.5, 1e-12);
  EXPECT_NEAR(c.bias, 0.5, 1e-12);
  EXPECT_NEAR(c.p99, 1.0 / 3.0, 1e-12);  // a pair's scale is its larger value
}

TEST(Compare, OnePixelOffIsRootOfItsShare) {
  const Picture r = uniformPicture(1.0f, 1.0f, 1.0f, 1.0f);
  Picture x = r;
  x.planes[0][3] = 2.0f;
  const Comparison c = comparePictures(x, "a", r, "b");
  EXPECT_NEAR(c.relativeRmse, std::sqrt(1.0 / 8.0) / 3.0, 1e-12);
  EXPECT_NEAR(c.bias, 1.0 / 8.0 / 3.0, 1e-12);
  EXPECT_NEAR(c.maximum, 0.5, 1e-12);
}

TEST(Compare, PixelsWithoutMediumDoNotCount) {
  Picture r = uniformPicture(1.0f, 1.0f, 1.0f, 1.0f), x = r;
  r.planes[3][0] = x.planes[3][0] = 1e-3f;
  x.planes[1][0] = 100.0f;
  const Comparison c = comparePictures(x, "a", r, "b");
  EXPECT_EQ(c.pixels, 7u);
  EXPECT_EQ(c.relativeRmse, 0.0);
}

TEST(Compare, BlackReferenceGivesInfinity) {
  const Comparison c = comparePictures(uniformPicture(1, 1, 1, 1), "a", uniformPicture(0, 0, 0, 1), "b");
  EXPECT_TRUE(std::isinf(c.relativeRmse));
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const Picture p = uniformPicture(1, 1, 1, 1);
  Picture other = p;
  other.width = 8;
  other.height = 1;
  EXPECT_THROW(comparePictures(p, "a", other, "b"), InputError);
  Picture bad = p;
  bad.planes[2][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(comparePictures(bad, "a", p, "b"), InputError);
}

TEST(Tolerance, NumbersAndPercent) {
  EXPECT_DOUBLE_EQ(parseTolerance("0.03"), 0.03);
  EXPECT_DOUBLE_EQ(parseTolerance("3%"), 0.03);
  for (const char* wrong : {"", "%", "3 %", "-1", "nan", "inf", "1%%", "abc"})
    EXPECT_THROW(parseTolerance(wrong), InputError) << wrong;
}

TEST(Frames, DigitsAndHashesAreReplaced) {
  EXPECT_EQ(framePath("a/b_0001.vdb", 48), "a/b_0048.vdb");
  EXPECT_EQ(framePath("b_1.vdb", 12), "b_12.vdb");
  EXPECT_EQ(framePath("a.####/b_###.vdb", 7), "a.####/b_007.vdb");
  EXPECT_THROW(framePath("cloud.vdb", 1), InputError);
  EXPECT_EQ(frameOutput("out/c.exr", 7), "out/c_0007.exr");
  EXPECT_EQ(frameOutput("out/c_##.exr", 7), "out/c_07.exr");
}

TEST(Methods, AreFoundByNameWhereBuilt) {
  for (const char* name : {"march", "cube", "dda", "reference"}) EXPECT_NE(findMethod(name).make, nullptr);
  for (const char* name : {"impostor", "phenomenological", "mrach"})
    EXPECT_THROW(findMethod(name), InputError) << name;
}

}  // namespace
}  // namespace nephele
