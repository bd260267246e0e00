// The table of hard cases: nothing that is not finite, negative or a share above 1 comes out of the march's
// C++ twin or of the reference; and the map's page and cells.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "preview/gpu/camera_rays.h"
#include "preview/measure/stability_page.h"
#include "preview/truth/reference_method.h"
#include "preview/twin/march_picture.h"

namespace nephele {
namespace {

constexpr int kSize = 10;

const std::vector<StabilityCase>& cases() {
  static const std::vector<StabilityCase> made = stabilityCases();
  return made;
}

std::string nameOf(const StabilityCase& on) { return on.axis + " " + on.value; }

/// Bad values in the twin's picture, one sample a pixel.
size_t badValues(const BrickVolume& bricks, const ViewedScene& view) {
  const shared::MarchParameters parameters = marchParameters(view, bricks, kSize, kSize, 3, true);
  size_t bad = 0;
  for (const TwinPixel& pixel : marchPicture(bricks, parameters, kSize, kSize, glm::vec2(0.5f), 1))
    for (int c = 0; c < 3; ++c) {
      const float radiance = pixel.radiance[c], through = pixel.transmittance[c];
      const bool good = std::isfinite(radiance) && radiance >= 0.0f && through >= 0.0f && through <= 1.0f &&
                        std::isfinite(pixel.depth);
      bad += good ? 0 : 1;
    }
  return bad;
}

void expectNoBadValueOfTheTwin(bool cached) {
  for (const StabilityCase& on : cases()) {
    ViewedScene view = on.view;
    view.scene.march.lightCache = cached;
    view.scene.march.cacheDepth = std::numeric_limits<double>::max();
    EXPECT_EQ(badValues(on.volume(), view), 0u) << nameOf(on);
  }
}

// Two tests, since a sanitized build takes a minute for both.
TEST(Stability, TheTwinHoldsNoBadValueInAnyCaseWithLightCached) { expectNoBadValueOfTheTwin(true); }

TEST(Stability, TheTwinHoldsNoBadValueInAnyCaseWithLightMarched) { expectNoBadValueOfTheTwin(false); }

TEST(Stability, TheReferenceHoldsNoBadValueInAnyCase) {
  const auto method = makeReferenceMethod({});
  PictureRequest request;
  request.width = request.height = kSize;
  request.samples = 2;
  request.bounces = 2;
  request.quiet = true;
  for (const StabilityCase& on : cases()) {
    const BrickVolume bricks = on.volume();
    method->setVolume(bricks);
    PictureCost cost;
    const BadValues bad = badValuesIn(method->render(on.view, request, cost));
    EXPECT_EQ(bad.notFinite + bad.negative, 0u) << nameOf(on);
  }
}

TEST(Stability, EachCaseIsOneOfItsAxis) {
  std::set<std::string> names, closed;
  std::string axis;
  for (const StabilityCase& on : cases()) {
    EXPECT_TRUE(names.insert(nameOf(on)).second) << nameOf(on);
    if (on.axis != axis) {
      EXPECT_TRUE(closed.insert(on.axis).second) << "cases of '" << on.axis << "' are not together";
    }
    axis = on.axis;
  }
}

Picture pictureOf(float red, float alpha) {
  Picture picture;
  picture.width = picture.height = 1;
  for (const char* name : {"R", "G", "B", "A"}) picture.add(name);
  picture.planes[0][0] = red;
  picture.planes[3][0] = alpha;
  return picture;
}

TEST(Stability, BadValuesAreCounted) {
  EXPECT_FALSE(badValuesIn(pictureOf(3.0f, 1.0f)).any());
  EXPECT_EQ(badValuesIn(pictureOf(NAN, 0.5f)).notFinite, 1u);
  EXPECT_EQ(badValuesIn(pictureOf(INFINITY, 0.5f)).notFinite, 1u);
  EXPECT_EQ(badValuesIn(pictureOf(-1e-9f, 0.5f)).negative, 1u);
  EXPECT_EQ(badValuesIn(pictureOf(0.0f, 1.01f)).aboveOne, 1u);
}

StabilityCell cellOf(const std::string& value, double error) {
  StabilityCell cell;
  cell.axis = "some axis";
  cell.value = value;
  cell.error = NoisyError{error, error, error, 0.0, 0.0};
  return cell;
}

TEST(Stability, ThePageSaysWhereAMethodMayBeTrusted) {
  StabilityResult result;
  result.ways = {{"a way", {}, {}}};
  result.cells = {cellOf("1", 0.2), cellOf("2", 0.01), cellOf("3", 0.02), cellOf("4", 0.2),
                  cellOf("5", 0.04)};
  EXPECT_NE(stabilityPage(result).find("| 1: 20%, 2: 1.0%, 3: 2.0%, 4: 20%, 5: 4.0% | 2 to 3, 5 |"),
            std::string::npos)
      << stabilityPage(result);
  EXPECT_TRUE(badCells(result).empty());
  result.cells[0].bad.negative = 2;
  EXPECT_EQ(badCells(result).size(), 1u);
}

}  // namespace
}  // namespace nephele
