// Warnings: each appears where the map's cases of its kind lie, none in the map's middle, and the table is
// that of the cases as they are.
#include "preview/measure/trust.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

SceneFacts factsOf(const StabilityCase& on) {
  const BrickVolume bricks = on.volume();
  return sceneFactsOf(brickFactsOf(bricks), bricks, on.view);
}

const StabilityCase& caseOf(const std::string& axis, const std::string& value) {
  static const std::vector<StabilityCase> cases = stabilityCases();
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const StabilityCase& on) {
    return on.axis == axis && on.value == value;
  });
  NEPHELE_CHECK_EQ(found != cases.end(), true);
  return *found;
}

/// All warnings in one text.
std::string warningsOf(const StabilityCase& on, std::string_view method = "march") {
  std::string text;
  for (const std::string& sentence : trustWarnings(method, factsOf(on), on.view, trustTable()))
    text += sentence + '\n';
  return text;
}

TEST(Trust, EachKindOfSceneOutsideTheMapIsWarnedOf) {
  struct Expected {
    const char *axis, *value, *sentence;
  };
  const Expected all[] = {
      {"optical depth", "10000", "march: voxels are optically thick; error up to "},
      {"step, voxels", "16", "march: steps are too long; error up to "},
      {"sheet of a voxel, optical depth", "100", "march: sheets as thin as a voxel; error up to "},
      {"sheet of a voxel, step in voxels", "4", "march: sheet thinner than a step; error up to "},
      {"checkerboard, optical depth of a voxel", "100",
       "march: density that changes from voxel to voxel; error up to "},
      {"one voxel of this density beside 0", "10000", "march: a lone dense voxel; error up to "},
      {"camera", "inside", "march: camera inside the medium; error up to "},
      {"point light, distance from the middle", "0", "march: point light inside the medium; error up to "}};
  for (const Expected& one : all) {
    const std::string text = warningsOf(caseOf(one.axis, one.value));
    EXPECT_NE(text.find(one.sentence), std::string::npos) << one.axis << ' ' << one.value << ":\n" << text;
  }
}

TEST(Trust, TheMiddleOfTheMapAndTruthAreNotWarnedOf) {
  for (const char* value : {"0.5", "1"}) EXPECT_EQ(warningsOf(caseOf("step, voxels", value)), "");
  EXPECT_EQ(warningsOf(caseOf("point light, distance from the middle", "1.5")), "");
  EXPECT_EQ(warningsOf(caseOf("camera", "on a face")), "");
  EXPECT_EQ(warningsOf(caseOf("optical depth", "10000"), "reference"), "");
}

TEST(Trust, ErrorsBetweenPlacesOfTheMapAreBetweenTheirs) {
  const TrustRow table[] = {{"dda", "step, voxels", 1.0, 0.1}, {"dda", "step, voxels", 4.0, 0.3}};
  StabilityCase on = caseOf("step, voxels", "2");
  const auto found = trustWarnings("dda", factsOf(on), on.view, table);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front(), "dda: steps are too long; error up to 20%");
}

TEST(Trust, SheetsAndGrainsAreToldApart) {
  const SceneFacts sheet = factsOf(caseOf("sheet of a voxel, tilt in degrees", "30"));
  EXPECT_GT(sheet.sheetShare, 0.9);
  EXPECT_LT(sheet.grainShare, 0.05);
  const SceneFacts board = factsOf(caseOf("checkerboard, optical depth of a voxel", "10"));
  EXPECT_GT(board.grainShare, 0.9);
  EXPECT_NEAR(board.grainDepth, 10.0, 1e-5);
  const SceneFacts ball = factsOf(caseOf("step, voxels", "0.5"));
  EXPECT_LT(ball.sheetShare + ball.grainShare, 0.05);
  EXPECT_NEAR(ball.peak, 1.0, 0.1);
}

TEST(Trust, TheTableIsOfTheCasesAsTheyAre) {
  size_t rows = 0;
  std::string missing;
  for (const StabilityCase& on : stabilityCases()) {
    const double fact = factOf(on.axis, factsOf(on));
    if (std::isnan(fact)) continue;
    for (const char* way : {"march, light cached", "march, light marched", "cube", "dda"}) {
      const bool found = std::any_of(trustTable().begin(), trustTable().end(), [&](const TrustRow& row) {
        constexpr double kDigits = 1e-4;  // five are written
        return row.way == way && row.axis == on.axis && std::abs(row.fact - fact) <= kDigits * fact;
      });
      if (!found) missing += std::string(way) + ", " + on.axis + ' ' + on.value + '\n';
      ++rows;
    }
  }
  EXPECT_EQ(missing, "") << "run `nephele-preview chart --stability` again";
  EXPECT_EQ(trustTable().size(), rows);
}

}  // namespace
}  // namespace nephele
