// Weather maps: texels where the map lies, profiles, bounds, and the pictures that are refused.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/fields/shared_text.h"
#include "tests/bake/field_samples.h"
#include "tests/scratch_folder.h"

namespace nephele::test {
namespace {

FieldPtr weather(const std::string& path, std::map<std::string, Value, std::less<>> given = {},
                 int upAxis = 2) {
  given.emplace("file", InputFile{path, {}});
  given.emplace("base", 100.0);
  given.emplace("top", 200.0);
  given.emplace("origin", std::array<double, 2>{1000, 2000});
  given.emplace("size", std::array<double, 2>{160, 120});
  return makeField("weather_map", std::move(given), {0.01, upAxis, 0, nullptr});
}

TEST(WeatherMap, ReadsTexelsWhereTheMapLies) {
  const ScratchFolder folder;
  const std::string path = folder.file("w.exr");
  const Picture picture = examples::weatherPicture();
  writeExr(path, picture);
  const FieldPtr up = weather(path), upY = weather(path, {}, 1);
  int clouds = 0;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 16; ++column)
      for (const double height : {103.0, 110.0, 125.0, 150.0}) {
        const size_t n = size_t(row * 16 + column);
        const float share = float(height - 100.0) / 100.0f / picture.planes[2][n];
        const float type = picture.planes[1][n];
        const float profile =
            shared::mixedProfile(shared::stratusProfile(share), shared::stratocumulusProfile(share),
                                 shared::cumulusProfile(share), type);
        const double expected = std::max(0.0, double(profile + picture.planes[0][n]) - 1.0);
        const double x = 1000 + 10 * (column + 0.5), side = 10 * (row + 0.5);
        EXPECT_NEAR(valueAt(*up, {x, 2120 - side, height}), expected, 1e-5);
        EXPECT_NEAR(valueAt(*upY, {x, height, 2000 + side}), expected, 1e-5);
        clouds += expected > 0.1;
      }
  EXPECT_GT(clouds, 100);
}

TEST(WeatherMap, MixesLinearlyBetweenTexels) {
  const ScratchFolder folder;
  const std::string path = folder.file("w.exr");
  Picture picture;
  picture.width = 2;
  picture.height = 1;
  picture.add("Y");
  picture.planes[0] = {0.2f, 1.0f};
  writeExr(path, picture);
  // Cumulus is full at half of its height, so the value is the coverage.
  const FieldPtr field = weather(path);
  EXPECT_NEAR(valueAt(*field, {1040, 2060, 150}), 0.2, 1e-6);
  EXPECT_NEAR(valueAt(*field, {1080, 2060, 150}), 0.6, 1e-6);
  EXPECT_NEAR(valueAt(*field, {1100, 2060, 150}), 0.8, 1e-6);
  EXPECT_NEAR(valueAt(*field, {1159, 2060, 150}), 1.0, 1e-6);
  EXPECT_EQ(valueAt(*field, {1161, 2060, 150}), 0.0f);
  EXPECT_EQ(valueAt(*weather(path, {{"outside", std::string("edge")}}), {9999, 0, 150}), 1.0f);
  EXPECT_EQ(valueAt(*field, {1100, 2060, 99.9}), 0.0f);
  EXPECT_EQ(valueAt(*field, {1100, 2060, 200.1}), 0.0f);
}

TEST(WeatherMap, ProfilesRiseAndFallInOrderOfTheirHeight) {
  for (int n = 0; n <= 100; ++n) {
    const float h = float(n) / 100.0f;
    for (const float v :
         {shared::stratusProfile(h), shared::stratocumulusProfile(h), shared::cumulusProfile(h)}) {
      EXPECT_GE(v, 0.0f);
      EXPECT_LE(v, 1.0f);
    }
  }
  EXPECT_EQ(shared::stratusProfile(0.3f), 0.0f);
  EXPECT_EQ(shared::stratocumulusProfile(0.3f), 1.0f);
  EXPECT_EQ(shared::stratocumulusProfile(0.65f), 0.0f);
  EXPECT_EQ(shared::cumulusProfile(0.65f), 1.0f);
  EXPECT_FLOAT_EQ(shared::mixedProfile(0.2f, 0.6f, 1.0f, 0.25f), 0.4f);
  EXPECT_FLOAT_EQ(shared::mixedProfile(0.2f, 0.6f, 1.0f, 0.75f), 0.8f);
}

TEST(WeatherMap, BoundsKnowTheTypeBetweenTheTypes) {
  const ScratchFolder folder;
  const std::string path = folder.file("w.exr");
  Picture picture;
  picture.width = 2;
  picture.height = 1;
  picture.planes[picture.add("R")] = {1.0f, 1.0f};
  picture.planes[picture.add("G")] = {0.0f, 1.0f};
  writeExr(path, picture);
  // At a twentieth of the height stratus is full and cumulus 5/12, but stratocumulus between them only 1/4.
  const FieldPtr field = weather(path);
  EXPECT_NEAR(valueAt(*field, {1010, 2060, 105}), 1.0, 1e-5);
  EXPECT_NEAR(valueAt(*field, {1080, 2060, 105}), 0.25, 1e-5);
  EXPECT_NEAR(valueAt(*field, {1150, 2060, 105}), 5.0 / 12.0, 1e-5);
  const Interval bounds = field->bounds({{1010, 2050, 105}, {1150, 2070, 105}});
  EXPECT_LE(bounds.low, 0.25);
  EXPECT_GT(bounds.low, 0.2);
}

TEST(WeatherMap, RefusesPicturesThatAreNoMaps) {
  const ScratchFolder folder;
  const auto complaint = [&](const std::string& channel, float value) -> std::string {
    Picture picture;
    picture.width = picture.height = 2;
    picture.planes[picture.add(channel)][3] = value;
    const std::string path = folder.file("bad.exr");
    writeExr(path, picture);
    try {
      weather(path);
    } catch (const InputError& error) {
      return error.diagnostics().front().sentence;
    }
    return "accepted";
  };
  EXPECT_EQ(complaint("depth", 0.5f), "has neither a channel R nor a channel Y for the coverage");
  EXPECT_NE(complaint("R", 1.5f).find("in channel R at pixel (1, 1); it must be 0 to 1"), std::string::npos);
  EXPECT_NE(complaint("R", NAN).find("at pixel (1, 1)"), std::string::npos);
  EXPECT_EQ(complaint("R", 1.0f), "accepted");
}

}  // namespace
}  // namespace nephele::test
