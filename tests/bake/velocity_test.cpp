// The velocities of an asset: from the motion of its fields, from fields of its own, and as a grid.
#include "bake/velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "bake/voxelize.h"
#include "tests/bake/field_samples.h"
#include "tests/scratch_folder.h"
#include "volume/difference.h"
#include "volume/info.h"

namespace nephele::test {
namespace {

struct Sample {
  glm::dvec3 at[kBlockPoints];
};

/// The velocity on the block of spacing 0.1 from (0.05, 0.05, 0.05) for a recipe whose asset has these lines.
std::optional<Sample> velocityOf(const std::string& lines) {
  ScratchFolder folder;
  const Pipeline pipeline =
      loadPipeline(folder.write("r.yaml", "assets:\n  puff:\n    voxel_size: 0.1\n" + lines));
  const Asset& asset = pipeline.assets.front();
  const VectorFieldPtr field = buildVelocity(asset, contextOf(pipeline, asset));
  if (!field) return std::nullopt;
  float x[kBlockPoints], y[kBlockPoints], z[kBlockPoints];
  field->evaluate({glm::dvec3(0.05), 0.1}, x, y, z);
  Sample sample;
  for (int n = 0; n < kBlockPoints; ++n) sample.at[n] = {double(x[n]), double(y[n]), double(z[n])};
  return sample;
}

void expectEverywhere(const std::string& lines, const glm::dvec3& expected) {
  const auto sample = velocityOf(lines);
  ASSERT_TRUE(sample) << lines;
  for (const glm::dvec3& v : sample->at) ASSERT_LT(glm::distance(v, expected), 1e-6) << lines;
}

TEST(Velocity, IsNoneUnlessAskedFor) {
  EXPECT_FALSE(velocityOf("    density: sphere\n"));
  EXPECT_FALSE(velocityOf("    velocity: false\n    density: sphere\n"));
}

TEST(Velocity, IsThatOfTheOnlyFieldThatMoves) {
  expectEverywhere(
      "    velocity: true\n    density: { multiply: [sphere, { fbm: { scroll: [1, 2, -3] } }] }\n",
      {1, 2, -3});
  expectEverywhere(
      "    velocity: true\n    density: { fbm: { scroll: [1, 0, 0], fine_scroll: [0, 2, 0] } }\n", {1, 1, 0});
  expectEverywhere("    velocity: true\n    density: { warp: { input: sphere, scroll: [0, 4, 0] } }\n",
                   {0, 4, 0});
  expectEverywhere(
      "    velocity: true\n    density: { warp: { input: { perlin: { scroll: [1, 0, 0] } }, scroll: [0, 4, "
      "0] } }\n",
      {1, 0, 0});
  expectEverywhere("    velocity: true\n    density: { perlin: { evolve: 1 } }\n", {0, 0, 0});
  expectEverywhere("    velocity: true\n    density: { transform: { input: sphere, scroll: [0, 0, 2] } }\n",
                   {0, 0, 2});
  expectEverywhere(
      "    velocity: true\n    density: { transform: { input: { perlin: { scroll: [1, 0, 0] } }, scale: [3, "
      "1, 1], "
      "rotate: [0, 0, 90], scroll: [0, 0, 2] } }\n",
      {0, 3, 2});
}

TEST(Velocity, IsThatOfTheLoopWhereThatChangesIt) {
  // 24 frames a second for 12: half a second, in which a period of 4 takes 8 a second, or 16.
  ScratchFolder folder;
  const Pipeline pipeline = loadPipeline(folder.write(
      "r.yaml",
      "assets:\n  puff:\n    voxel_size: 0.1\n    frames: 1-12\n    loop: true\n    velocity: true\n"
      "    density: { perlin: { period: 4, scroll: [9, 0, 0] } }\n"));
  const Asset& asset = pipeline.assets.front();
  float x[kBlockPoints], y[kBlockPoints], z[kBlockPoints];
  buildVelocity(asset, contextOf(pipeline, asset, 3))->evaluate({}, x, y, z);
  EXPECT_EQ(x[77], 8.0f);
}

TEST(Velocity, OfSeveralIsTheirMeanByDensity) {
  const auto sample = velocityOf(
      "    velocity: true\n    density:\n      add:\n"
      "        - multiply: [1, { ridged: { scroll: [4, 0, 0] } }]\n"
      "        - multiply: [3, { ridged: { scroll: [0, 4, 0] } }]\n");
  ASSERT_TRUE(sample);
  for (const glm::dvec3& v : sample->at) {
    // Both noises are the same pattern where time is 0, so that the weights are 1 and 3.
    ASSERT_NEAR(v.x, 1.0, 1e-5);
    ASSERT_NEAR(v.y, 3.0, 1e-5);
    ASSERT_EQ(v.z, 0.0);
  }
}

TEST(Velocity, WeighsByWhatTheGridHoldsWithinATransform) {
  // In the transform a voxel is 1 unit: noise of cells of 1 is left out of the density, and has no say here.
  expectEverywhere(
      "    velocity: true\n    density:\n      transform:\n        scale: [0.1, 0.1, 0.1]\n        input:\n"
      "          add:\n            - perlin: { cell_size: 1, scroll: [50, 0, 0] }\n"
      "            - perlin: { cell_size: 40, scroll: [0, 50, 0] }\n",
      {0, 5, 0});
}

TEST(Velocity, OfACurlIsItsThreeComponents) {
  const auto sample =
      velocityOf("    velocity: { multiply: [2, { curl: { seed: 5 } }] }\n    density: sphere\n");
  ASSERT_TRUE(sample);
  const BuildContext context{0.1, 2, 0, nullptr};
  for (int axis = 0; axis < 3; ++axis) {
    const FieldPtr part =
        makeField("curl", {{"component", std::string(1, char('x' + axis))}, {"seed", int64_t{5}}}, context);
    for (int n = 0; n < kBlockPoints; n += 7) {
      const glm::dvec3 p = glm::dvec3(0.05) + 0.1 * glm::dvec3(n / 64, n / 8 % 8, n % 8);
      ASSERT_NEAR(sample->at[n][axis], 2.0 * double(valueAt(*part, p)), 2e-5);
    }
  }
  expectEverywhere("    velocity: [1, { constant: { value: -2 } }, 0.5]\n    density: sphere\n",
                   {1, -2, 0.5});
}

TEST(Velocity, RefusesWhatIsNoVector) {
  const auto refusal = [](const std::string& velocity) -> std::string {
    try {
      velocityOf("    velocity: " + velocity + "\n    density: sphere\n");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(refusal("sphere").find("4:15: error: 'velocity' needs three components"), std::string::npos);
  EXPECT_NE(refusal("{ curl: { component: x } }").find("needs three components"), std::string::npos);
  EXPECT_NE(refusal("[1, 2]").find("takes three fields, one a component, not 2"), std::string::npos);
  EXPECT_NE(refusal("yes_please").find("unknown field 'yes_please'"), std::string::npos);
}

/// A ball that turns about z at one radian a second.
Velocities turning(const Voxelized& density, const VoxelizeSettings& settings, float speed) {
  return voxelizeVelocity(density, settings, [speed](const Lattice& lattice, float* x, float* y, float* z) {
    for (int n = 0; n < kBlockPoints; ++n) {
      const glm::dvec3 p = lattice.origin + lattice.spacing * glm::dvec3(n / 64, n / 8 % 8, n % 8);
      x[n] = -speed * float(p.y);
      y[n] = speed * float(p.x);
      z[n] = 0.0f;
    }
  });
}

TEST(VelocityGrid, HoldsTheVoxelsOfTheDensityAndIsCompared) {
  const VoxelizeSettings settings{0.05, 0.001, false};
  const Voxelized ball = voxelize(*makeField("sphere", {{"falloff", 0.2}}), settings);
  const Velocities slow = turning(ball, settings, 1.0f), fast = turning(ball, settings, 1.25f);
  EXPECT_NEAR(slow.largestSpeed, 1.0, 0.05);
  EXPECT_NE(slow.contentHash, fast.contentHash);
  EXPECT_EQ(slow.contentHash, turning(ball, settings, 1.0f).contentHash);
  ScratchFolder folder;
  writeDensity(folder.file("a.vdb"), ball, {}, &slow);
  writeDensity(folder.file("b.vdb"), ball, {}, &fast);
  writeDensity(folder.file("c.vdb"), ball, {});
  const FileInfo info = inspectFile(folder.file("a.vdb"));
  ASSERT_EQ(info.grids.size(), 2u);
  const GridInfo& vel = info.grids[0].name == "vel" ? info.grids[0] : info.grids[1];
  EXPECT_EQ(vel.type, "vec3s");
  EXPECT_EQ(vel.activeVoxels, ball.voxelsActive);
  EXPECT_EQ(vel.contentHash, slow.contentHash);
  EXPECT_EQ(vel.metadata.at("vector_type"), "contravariant relative");
  const GridDifference same = differenceOfFiles(folder.file("a.vdb"), folder.file("a.vdb"));
  EXPECT_TRUE(same.velocities);
  EXPECT_EQ(same.largestVelocity, 0.0);
  const GridDifference d = differenceOfFiles(folder.file("a.vdb"), folder.file("b.vdb"));
  EXPECT_EQ(d.largest, 0.0);
  EXPECT_NEAR(d.relativeVelocity(), 0.25, 1e-6);
  EXPECT_NEAR(differenceOfFiles(folder.file("a.vdb"), folder.file("c.vdb")).relativeVelocity(), 1.0, 1e-12);
  EXPECT_FALSE(differenceOfFiles(folder.file("c.vdb"), folder.file("c.vdb")).velocities);
}

TEST(VelocityGrid, RefusesWhatTheFileCannotHold) {
  const VoxelizeSettings half{0.1, 0.001, true};
  const Voxelized ball = voxelize(*makeField("sphere"), half);
  EXPECT_THROW(turning(ball, half, 1e6f), VoxelizeError);
  EXPECT_THROW(turning(ball, half, NAN), VoxelizeError);
}

}  // namespace
}  // namespace nephele::test
