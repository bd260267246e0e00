// Tolerances: they hold on rays that were not measured, choose no finer than needed, and stand in the file.
#include "bake/choice.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bake/cost_chart.h"
#include "bake/run.h"
#include "bake/trial.h"
#include "tests/scratch_folder.h"
#include "volume/bricks.h"
#include "volume/vdb_header.h"

namespace nephele::test {
namespace {

constexpr const char* kSphere = "sphere: { radius: 1, falloff: 0.6 }";
constexpr const char* kNoise =
    "multiply: [{ sphere: { radius: 1, falloff: 0.8 } }, { remap: { from: [-0.5, 0.5], to: [0, 1], input: "
    "{ fbm: { cell_size: 0.7, octaves: 6, gain: 0.3 } } } }]";
constexpr uint64_t kOtherRays = 7;

class ChoiceTest : public ::testing::Test {
 protected:
  Pipeline recipe(const std::string& density, const std::string& keys) {
    const std::string path = scratch_.file("recipe.yaml");
    std::ofstream(path) << "assets:\n  cloud:\n    " << keys << "\n    density: { " << density << " }\n";
    return loadPipeline(path);
  }
  std::string folder() const { return scratch_.path(); }

  double freshError(const Pipeline& pipeline, const Choice& choice) const {
    return depthError(pipeline, finerThan(choice.asset), choice.asset, kChoiceRays, kOtherRays, folder());
  }

  ScratchFolder scratch_;
};

TEST_F(ChoiceTest, HoldsOnFreshRays) {
  for (const char* density : {kSphere, kNoise})
    for (const char* tolerance : {"10%", "3%"}) {
      const Pipeline pipeline = recipe(density, std::string("tolerance: ") + tolerance);
      const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
      EXPECT_LE(choice.measured, kChoiceShare * choice.asked);
      EXPECT_LE(freshError(pipeline, choice), choice.asked) << density << ' ' << tolerance;
    }
}

TEST_F(ChoiceTest, TakesTheCoarsestVoxelsThatHold) {
  const Pipeline pipeline = recipe(kNoise, "tolerance: 3%");
  const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
  double coarsestFailure = 1e9;
  for (const ChoiceTrial& trial : choice.trials) {
    if (trial.mostOctaves == kAllOctaves && trial.error > kChoiceShare * choice.asked &&
        trial.voxelSize > choice.asset.voxelSize)
      coarsestFailure = std::min(coarsestFailure, trial.voxelSize);
  }
  // Three bisections of a factor of two; confirming takes such steps too.
  EXPECT_LE(coarsestFailure / choice.asset.voxelSize, std::pow(2.0, 1.0 / 8.0) + 1e-6);
  EXPECT_EQ(choice.asset.precision, Precision::half);
}

TEST_F(ChoiceTest, LeavesOutOctavesThatDoNotMatter) {
  const Pipeline pipeline = recipe(kNoise, "tolerance: 10%");
  const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
  EXPECT_LT(choice.asset.mostOctaves, 6);
  EXPECT_NE(choiceAsText(choice).find("octaves beyond"), std::string::npos) << choiceAsText(choice);
}

TEST_F(ChoiceTest, TakesTheCoarsestStepThatHolds) {
  const Pipeline pipeline = recipe(kSphere, "tolerance: 10%");
  const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
  const double step = choice.asset.densityStep;
  ASSERT_GT(step, 0.0);
  EXPECT_NE(choiceAsText(choice).find(", density_step "), std::string::npos) << choiceAsText(choice);
  for (const ChoiceTrial& trial : choice.trials)
    EXPECT_TRUE(trial.densityStep <= step || trial.error > kChoiceShare * choice.asked) << trial.densityStep;
  // Files become smaller by it, by nothing else.
  const TrialBaker baker(pipeline, pipeline.assets[0], {std::nullopt}, folder());
  Asset exact = choice.asset;
  exact.densityStep = 0.0;
  const TrialBake stepped = baker.bake(0, choice.asset, scratch_.file("stepped.trial")),
                  plain = baker.bake(0, exact, scratch_.file("exact.trial"));
  EXPECT_EQ(stepped.voxelsActive, plain.voxelsActive);
  EXPECT_LT(stepped.fileBytes, plain.fileBytes);
  const Pipeline without = recipe(kSphere, "tolerance: 10%\n    density_step: 0");
  const Choice unstepped = chooseFor(without, without.assets[0], folder());
  EXPECT_EQ(unstepped.asset.densityStep, 0.0);
  EXPECT_EQ(unstepped.asset.voxelSize, choice.asset.voxelSize);
}

TEST_F(ChoiceTest, TheStepStandsInTheFile) {
  const Pipeline pipeline = recipe(kSphere, "voxel_size: 0.1\n    density_step: 0.125");
  BakeOptions options;
  options.outFolder = folder();
  options.quiet = true;
  const std::string file = bakeAll(pipeline, options)[0].file;
  EXPECT_EQ(loadBricks(file).metadata.at("density_step"), "0.125");
}

TEST_F(ChoiceTest, SpecksThatAreTooFarApartAreRefusedWithTheAssetsPlace) {
  const std::string path = scratch_.file("specks.yaml");
  std::ofstream(path) << R"(assets:
  specks:
    tolerance: 1%
    particles:
      emitters:
        - { bursts: [[0, 1]], particle_radius: 0.001, shape: point, center: [-4, -4, -4] }
        - { bursts: [[0, 1]], particle_radius: 0.001, shape: point, center: [4, 4, 4] }
)";
  const Pipeline pipeline = loadPipeline(path);
  const TrialBaker baker(pipeline, pipeline.assets[0], {std::nullopt}, folder());
  Asset look = pipeline.assets[0];
  look.voxelSize = 0.001;
  try {
    baker.depths(0, look, {20.0, {{glm::dvec3(-5.0), glm::dvec3(5.0)}}});  // through both
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    const Diagnostic& said = error.diagnostics().front();
    EXPECT_EQ(said.where.line, 2);
    EXPECT_NE(said.sentence.find("asset 'specks': voxels of "), std::string::npos) << said.sentence;
    EXPECT_NE(said.hint.find("give 'voxel_size'"), std::string::npos) << said.hint;
  }
}

/// A frame of particles, eaten into by noise and not.
Pipeline particlesOf(const ScratchFolder& scratch, const std::string& size, const std::string& erosion) {
  const std::string path = scratch.file("particles.yaml");
  std::ofstream(path) << "assets:\n  smoke:\n    " << size << R"(
    frames: 6-6
    fps: 12
    cutoff: 0.01
    particles:
      emitters: [{ shape: sphere, radius: 0.4, rate: 120, velocity: [0, 0, 1], spread: 0.4, particle_radius: 0.3, life: 3 }]
)" << erosion;
  return loadPipeline(path);
}
constexpr const char* kErosion =
    "      erosion: { amount: 1, field: { fbm: { basis: worley, cell_size: 0.8, octaves: 2 } } }\n";

TEST_F(ChoiceTest, ParticlesAreMeasuredAsTheyAreBaked) {
  for (const char* erosion : {"", kErosion}) {
    const Pipeline pipeline = particlesOf(scratch_, "voxel_size: 0.015", erosion);
    const Asset& look = pipeline.assets[0];
    const TrialBaker baker(pipeline, look, {6}, folder());
    const Chords chords = baker.chords(0, 500, kOtherRays);
    const TrialBake baked = baker.bake(0, look);
    const TrialBaker::Depths seen = baker.depths(0, look, chords);
    // Masses of wide eroded particles are found from some of their voxels.
    EXPECT_LT(differenceOf(depthsAlong(baked.bricks, chords.lines), seen.depths).relative(), 1e-3) << erosion;
    // Seen by few rays, with the voxel that densities fade over.
    EXPECT_NEAR(seen.voxels / double(baked.voxelsActive), 1.0, 0.3) << erosion;
  }
}

TEST_F(ChoiceTest, ParticlesHoldOnFreshRays) {
  for (const char* erosion : {"", kErosion}) {
    const Pipeline pipeline = particlesOf(scratch_, "tolerance: 10%", erosion);
    const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
    EXPECT_LE(choice.measured, kChoiceShare * choice.asked);
    EXPECT_LE(freshError(pipeline, choice), choice.asked) << erosion;
  }
}

TEST_F(ChoiceTest, ALooserToleranceIsNeverDearer) {
  double last = 0.0;
  for (const char* tolerance : {"1%", "3%", "10%"}) {
    const Pipeline pipeline = recipe(kSphere, std::string("tolerance: ") + tolerance);
    const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
    EXPECT_GE(choice.asset.voxelSize, last) << tolerance;
    last = choice.asset.voxelSize;
  }
}

TEST_F(ChoiceTest, IsTheSameOnAnyNumberOfThreads) {
  const Pipeline pipeline = recipe(kNoise, "tolerance: 10%");
  const Choice many = chooseFor(pipeline, pipeline.assets[0], folder());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Choice alone = chooseFor(pipeline, pipeline.assets[0], folder());
  EXPECT_EQ(many.asset.voxelSize, alone.asset.voxelSize);
  EXPECT_EQ(many.measured, alone.measured);
  EXPECT_EQ(many.trials.size(), alone.trials.size());
}

TEST_F(ChoiceTest, ASequenceHasOneVoxelSize) {
  const Pipeline pipeline = recipe("sphere: { radius: 1, falloff: 0.6 }", "tolerance: 10%\n    frames: 1-5");
  const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
  ASSERT_EQ(choice.frames.size(), 3u);
  EXPECT_EQ(choice.frames[1], 3);
  BakeOptions options;
  options.outFolder = folder();
  options.quiet = true;
  options.frames = FrameRange{4, 5};
  for (const BakeRecord& record : bakeAll(pipeline, options)) {
    ASSERT_TRUE(record.choice);
    EXPECT_EQ(record.choice->asset.voxelSize, choice.asset.voxelSize);
  }
}

TEST_F(ChoiceTest, StandsInTheFileWhichIsThenUpToDate) {
  const Pipeline pipeline = recipe(kSphere, "tolerance: 10%");
  BakeOptions options;
  options.outFolder = folder();
  options.quiet = true;
  const std::vector<BakeRecord> records = bakeAll(pipeline, options);
  const VdbHeader header = readVdbHeader(records[0].file);
  EXPECT_EQ(header.metadata.at("tolerance"), choiceAsText(*records[0].choice));
  EXPECT_NE(reportAsJson(records).find("\"measured\""), std::string::npos);
  EXPECT_TRUE(bakeAll(pipeline, options)[0].skipped);
  EXPECT_FALSE(bakeAll(recipe(kSphere, "tolerance: 9%"), options)[0].skipped);
}

TEST_F(ChoiceTest, NoiseFinerThanAUnitEndsWhereItsBoxDoes) {
  const Pipeline pipeline =
      recipe("multiply: [{ box: { size: [1, 1, 1] } }, { max: [{ perlin: { cell_size: 0.4 } }, 0] }]",
             "tolerance: 10%");
  const Choice choice = chooseFor(pipeline, pipeline.assets[0], folder());
  EXPECT_LT(choice.asset.voxelSize, 0.4);
  EXPECT_LE(choice.measured, kChoiceShare * choice.asked);
}

TEST_F(ChoiceTest, RaysGoThroughASheetThatIsTooThinToBeSeen) {
  // 16 voxels across it would be more than 10^12; no voxel of those that are baked lies in the second.
  for (const char* centre : {"0, 0, 0", "0, 0, 0.7"}) {
    const Pipeline pipeline =
        recipe(std::string("box: { size: [2000, 2000, 0.1], rounding: 0, center: [") + centre + "] }",
               "tolerance: 10%");
    const Chords chords =
        TrialBaker(pipeline, pipeline.assets[0], {std::nullopt}, folder()).chords(0, 100, kOtherRays);
    EXPECT_EQ(chords.lines.size(), 100u);
    EXPECT_NEAR(chords.radius, 1000.0 * std::sqrt(2.0), 10.0) << centre;
  }
}

TEST_F(ChoiceTest, RefusesWhatNeverEnds) {
  const Pipeline pipeline = recipe("constant: { value: 1 }", "tolerance: 10%");
  try {
    chooseFor(pipeline, pipeline.assets[0], folder());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.diagnostics()[0].sentence.find("ends somewhere"), std::string::npos);
  }
}

TEST_F(ChoiceTest, AChartHasErrorsThatGrowWithTheVoxels) {
  const Pipeline pipeline = recipe(kNoise, "voxel_size: 0.07");
  const CostChart chart = measureCosts(pipeline, pipeline.assets[0], folder(), true);
  ASSERT_GE(chart.points.size(), 10u);
  EXPECT_EQ(chart.referenceSize, 0.035);
  const CostPoint& finest = chart.points[0];
  const CostPoint& coarsest = chart.points[4];
  ASSERT_EQ(coarsest.sweep, "voxel size");
  EXPECT_GT(coarsest.depthRms, 2.0 * finest.depthRms);
  EXPECT_LT(coarsest.voxelsActive, finest.voxelsActive / 32);
  EXPECT_LT(coarsest.fileBytes, finest.fileBytes);
  std::vector<uint64_t> stepped;
  for (const CostPoint& point : chart.points)
    if (point.sweep == "density step") stepped.push_back(point.fileBytes);
  ASSERT_EQ(stepped.size(), 3u);
  EXPECT_LT(stepped[2], stepped[0]);
  ASSERT_EQ(chart.fronts.size(), 6u);
  for (const CostFront& front : chart.fronts) EXPECT_FALSE(front.points.empty());
  writeCostChart(folder(), chart);
  for (const char* name : {"chart.csv", "index.html"})
    EXPECT_GT(std::filesystem::file_size(scratch_.file(name)), 500u) << name;
}

CostPoint pointOf(const std::string& sweep, double size, int octaves, uint64_t bytes, double depth) {
  CostPoint point;
  point.sweep = sweep;
  point.look.voxelSize = size;
  point.look.mostOctaves = octaves;
  point.fileBytes = point.gridBytes = bytes;
  point.seconds = double(bytes);
  point.depthLargest = point.densityRmse = depth;
  return point;
}

TEST(CostFronts, JointSettingsAreThoseThatMayBeWorthTheirCost) {
  // Two octaves cost half and err by as good as nothing more; one octave errs by a half.
  const std::vector<CostPoint> points = {
      pointOf("voxel size", 1.0, kAllOctaves, 1000, 0.01), pointOf("voxel size", 2.0, kAllOctaves, 100, 0.1),
      pointOf("octaves", 1.0, 2, 500, 0.011), pointOf("octaves", 1.0, 1, 400, 0.5)};
  const std::vector<CostPoint> joint = jointSettings(points);
  ASSERT_FALSE(joint.empty());
  EXPECT_EQ(joint[0].look.voxelSize, 2.0);
  EXPECT_EQ(joint[0].look.mostOctaves, 2);
  EXPECT_EQ(joint[0].fileBytes, 50u);
  EXPECT_NEAR(joint[0].depthLargest, 0.101, 1e-12);
}

TEST(CostFronts, LeaveOutWhatIsHardlyBetterAndWhatMissesAll) {
  const std::vector<CostPoint> points = {
      pointOf("voxel size", 1.0, kAllOctaves, 1000, 0.01), pointOf("voxel size", 2.0, kAllOctaves, 100, 0.1),
      pointOf("precision", 2.0, kAllOctaves, 200, 0.0999), pointOf("cutoff", 1.0, kAllOctaves, 10, 1.0)};
  const std::vector<CostFront> fronts = costFronts(points);
  ASSERT_EQ(fronts.size(), 6u);
  EXPECT_EQ(fronts[0].points, (std::vector<size_t>{1, 0}));
  EXPECT_EQ(int(fronts[0].error), int(CostError::depth));
  EXPECT_EQ(int(fronts[0].cost), int(CostKind::file));
}

TEST(CostFronts, WhatMissesADepthShadowsNothing) {
  std::vector<CostPoint> points = {pointOf("voxel size", 1.0, kAllOctaves, 1000, 0.01),
                                   pointOf("voxel size", 2.0, kAllOctaves, 100, 0.1),
                                   pointOf("cutoff", 1.0, kAllOctaves, 10, 1.0)};
  points[2].densityRmse = 0.001;  // less than the others' errors, for less
  for (const CostFront& front : costFronts(points)) {
    if (front.cost != CostKind::file) continue;
    EXPECT_EQ(front.points, (std::vector<size_t>{1, 0}));
  }
}

}  // namespace
}  // namespace nephele::test
