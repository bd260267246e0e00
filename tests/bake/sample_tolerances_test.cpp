// Tolerances of samples hold along rays that their choice did not see: a sheet, a crisp noise, a voxel cube
// and particles. All samples: nephele_tolerances (bench/).
#include <gtest/gtest.h>

#include "bake/choice.h"
#include "tests/scratch_folder.h"

namespace nephele::test {
namespace {

constexpr uint64_t kFreshSeed = 11;

class SampleTolerance : public ::testing::TestWithParam<std::tuple<const char*, double>> {};

TEST_P(SampleTolerance, HoldsOnFreshRays) {
  const auto& [name, tolerance] = GetParam();
  const ScratchFolder scratch;
  const Pipeline pipeline = loadPipeline(std::string(NEPHELE_SOURCE_FOLDER "/samples/") + name + ".yaml");
  Asset asset = pipeline.assets.front();
  asset.tolerance = tolerance;
  const Choice choice = chooseFor(pipeline, asset, scratch.path());
  const double fresh =
      depthError(pipeline, finerThan(choice.asset), choice.asset, kChoiceRays, kFreshSeed, scratch.path());
  EXPECT_LE(fresh, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Samples, SampleTolerance,
                         ::testing::Combine(::testing::Values("cirrostratus", "report_sphere", "cube_perlin",
                                                              "breath"),
                                            ::testing::Values(0.10, 0.03)));

}  // namespace
}  // namespace nephele::test
