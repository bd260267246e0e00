// EXR and PNG, and the tone curve against its closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/files.h"
#include "base/picture.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

Picture makePicture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (const char* name : {"R", "G", "B", "A", "depth"}) picture.add(name);
  for (size_t c = 0; c < picture.planes.size(); ++c)
    for (size_t i = 0; i < picture.planes[c].size(); ++i)
      picture.planes[c][i] = static_cast<float>(c) + static_cast<float>(i) / 7.0f;
  return picture;
}

TEST(Exr, RoundTripsEveryBit) {
  const ScratchFolder scratch;
  Picture picture = makePicture(5, 3);
  picture.planes[4][0] = std::numeric_limits<float>::infinity();
  picture.planes[4][1] = std::numeric_limits<float>::denorm_min();
  writeExr(scratch.file("a.exr"), picture);
  const Picture read = readExr(scratch.file("a.exr"));
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_EQ(read.names, (std::vector<std::string>{"A", "B", "G", "R", "depth"}));
  for (const std::string& name : picture.names)
    EXPECT_EQ(read.planes[static_cast<size_t>(read.find(name))],
              picture.planes[static_cast<size_t>(picture.find(name))]);
  EXPECT_EQ(read.find("nothing"), -1);
  EXPECT_EQ(scratch.fileCount(), 1);
}

TEST(Exr, RefusesWhatIsNone) {
  const ScratchFolder scratch;
  EXPECT_THROW(readExr(scratch.file("missing.exr")), InputError);
  EXPECT_THROW(readExr(scratch.write("junk.exr", "not a picture")), InputError);
  EXPECT_THROW(readExr(scratch.write("empty.exr", "")), InputError);
  writeExr(scratch.file("a.exr"), makePicture(40, 30));
  const std::string whole = readWhole(scratch.file("a.exr"));
  for (size_t length = 4; length < whole.size(); length += whole.size() / 9)
    EXPECT_THROW(readExr(scratch.write("cut.exr", whole.substr(0, length))), InputError) << length;
  EXPECT_THROW(writeExr(scratch.file("missing/a.exr"), makePicture(2, 2)), WorldError);
}

/// The curve as its definition says, in double.
int expectedTone(double x, double ev) {
  const double y = 1.0 - std::exp(-x * std::pow(2.0, ev));
  const double srgb = y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1.0 / 2.4) - 0.055;
  return static_cast<int>(std::floor(255.0 * srgb + 0.5));
}

TEST(ToneMap, EqualsItsClosedForm) {
  for (const float ev : {-3.0f, 0.0f, 0.5f, 4.0f})
    for (float x = 0.0f; x < 8.0f; x += 0.0137f) {
      const auto shown = toneMap({x, 2.0f * x, 0.0f}, ev);
      EXPECT_EQ(shown[0], expectedTone(double{x}, double{ev})) << x;
      EXPECT_EQ(shown[1], expectedTone(2.0 * double{x}, double{ev})) << x;
      EXPECT_EQ(shown[2], 0);
    }
  EXPECT_EQ(toneMap({std::numeric_limits<float>::infinity(), 1e30f, 100.0f}, 0.0f),
            (std::array<unsigned char, 3>{255, 255, 255}));
}

TEST(ToneMap, RefusesNegativeAndNan) {
  EXPECT_THROW(toneMap({-1e-6f, 0.0f, 0.0f}, 0.0f), WorldError);
  EXPECT_THROW(toneMap({0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f}, 0.0f), WorldError);
}

TEST(Png, IsWrittenOverTheBackdrop) {
  const ScratchFolder scratch;
  Picture picture;
  picture.width = 4;
  picture.height = 2;
  for (const char* name : {"R", "G", "B", "A"}) picture.add(name);
  writePng(scratch.file("a.png"), picture, 0.0f, Backdrop{{1.0f, 1.0f, 1.0f}, {0.5f, 0.5f, 0.5f}});
  const std::string bytes = readWhole(scratch.file("a.png"));
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\4\0\0\0\2", 8));  // width and height of the IHDR chunk
  picture.planes[0][3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(writePng(scratch.file("b.png"), picture, 0.0f, {}), WorldError);
  EXPECT_EQ(scratch.fileCount(), 1);
}

}  // namespace
}  // namespace nephele
