// The particle block of a file's metadata, and the recipe written from it. Also what a live simulation needs
// to know before it begins.
#include "preview/app/live_recipe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "particles/live_plan.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

BrickVolume fileOf(const std::string& block) {
  BrickVolume volume;
  volume.path = "smoke_0007.vdb";
  volume.worldFromIndex = glm::dmat4(0.05);
  volume.worldFromIndex[3][3] = 1.0;
  volume.upAxis = 'y';
  volume.metadata = {{"particles", block},       {"fps", "30"}, {"seed", "5"}, {"cutoff", "0.01"},
                     {"density_step", "0.0625"}, {"frame", "7"}};
  return volume;
}

const char* const kBlock = "emitters: [{ radius: 0.3, rate: 200 }]\nforces: { drag: 2 }\nsubsteps: 3\n";

TEST(LiveRecipe, ReadsTheFilesMetadata) {
  const auto source = liveSourceOf(fileOf(kBlock));
  ASSERT_TRUE(source);
  EXPECT_EQ(source->name, "smoke");
  EXPECT_EQ(source->settings.fps, 30.0);
  EXPECT_EQ(source->settings.seed, 5u);
  EXPECT_EQ(source->settings.upAxis, 1);
  EXPECT_NEAR(source->voxelSize, 0.05, 1e-15);
  EXPECT_EQ(source->cutoff, 0.01);
  EXPECT_EQ(source->densityStep, 0.0625);
  EXPECT_TRUE(source->framed);
  EXPECT_EQ(source->system.emitters.at(0).radius, 0.3);
  EXPECT_EQ(source->system.substeps, 3);
  EXPECT_FALSE(liveSourceOf(BrickVolume{}));
}

TEST(LiveRecipe, RefusesABlockThatIsNone) {
  for (const char* block : {"emitters: 3\n", "emitters: [{ rate: -1 }]\n", "[", "{}"})
    EXPECT_THROW(liveSourceOf(fileOf(block)), InputError) << block;
  BrickVolume still = fileOf(kBlock);
  still.metadata["fps"] = "0";
  EXPECT_THROW(liveSourceOf(still), InputError);
}

TEST(LiveRecipe, HoldsTheSystemAsItWasChanged) {
  const auto source = liveSourceOf(fileOf(kBlock));
  ParticleSystem system = source->system;
  system.forces.gravity = {0.0, -0.1, 1.0 / 3.0};
  const std::string text = recipeOf(*source, system, "mine", FrameRange{3, 9}, "look: physical\n");
  const yaml::NodePtr recipe = yaml::parse(text, "mine.yaml");
  Diagnostics complaints;
  const auto at = [&](const yaml::NodePtr& node, const std::string& key) {
    for (const yaml::Entry& entry : node->entries)
      if (entry.key == key) return entry.value;
    throw std::runtime_error("no " + key + " in\n" + text);
  };
  const yaml::NodePtr asset = at(at(recipe, "assets"), "mine");
  const ParticleSystem read = readParticles(*at(asset, "particles"), complaints);
  complaints.throwIfAny();
  EXPECT_EQ(writeParticles(read), writeParticles(system));
  EXPECT_EQ(read.forces.gravity, system.forces.gravity);
  EXPECT_EQ(at(asset, "frames")->scalar, "3-8");
  EXPECT_EQ(at(asset, "fps")->scalar, "30");
  EXPECT_EQ(at(recipe, "up_axis")->scalar, "y");
  EXPECT_EQ(at(at(recipe, "scene"), "look")->scalar, "physical");
}

TEST(LiveRecipe, OverwritesNothing) {
  const ScratchFolder folder;
  const auto source = liveSourceOf(fileOf(kBlock));
  const auto write = [&] { return writeLiveRecipe(folder.path(), *source, source->system, {}, ""); };
  EXPECT_EQ(write(), folder.file("smoke_live.yaml"));
  EXPECT_EQ(write(), folder.file("smoke_live_b.yaml"));
  EXPECT_EQ(write(), folder.file("smoke_live_c.yaml"));
}

TEST(LivePlan, RingsHoldALifeOfBirths) {
  ParticleSystem system;
  Emitter steady, puff;
  steady.rate = {{0.0, 100.0}};
  steady.life = 2.0;
  puff.rate = {{0.0, 1000.0}, {0.5, 0.0}};  // 250 in all
  puff.bursts = {{1.0, 40.0}};
  puff.life = 1e6;
  system.emitters = {steady, puff};
  const auto rings = slotRings(system, 0.5);
  ASSERT_EQ(rings.size(), 2u);
  EXPECT_EQ(rings[0].count, 301u);  // a life and two steps, and one for what is cut off of a particle
  EXPECT_EQ(rings[1].first, 301u);
  EXPECT_EQ(rings[1].count, 40u + 250u + 1u);
  const double ball = 4.0 / 3.0 * std::numbers::pi * 1e-3;
  EXPECT_NEAR(mostMass(system, rings), double(rings[0].count + rings[1].count) * ball, 1e-9);
  system.densityOverLife = {{0.0, 0.5}, {1.0, 3.0}};
  EXPECT_NEAR(mostMass(system, rings), 3.0 * double(rings[0].count + rings[1].count) * ball, 1e-9);
  system.emitters[0].life = 1e9;
  EXPECT_THROW(slotRings(system, 0.5), SimulationError);
  system.emitters[0].life = 1.0;
  system.emitters[0].shape = EmitterShape::mesh;
  EXPECT_THROW(slotRings(system, 0.5), SimulationError);
}

TEST(LivePlan, BoxHoldsTheWayOfAFewParticles) {
  ParticleSystem system;
  Emitter e;
  e.shape = EmitterShape::point;
  e.rate = {{0.0, 1e5}};
  e.velocity = {1.0, 0.0, 0.0};
  e.particleRadius = 0.25;
  e.life = 10.0;
  system.emitters = {e};
  const auto box = motionBox(system, {24.0, 2, 0}, 48);
  ASSERT_TRUE(box);
  constexpr double kFloat = 1e-5, kTwoSeconds = 2.0;
  EXPECT_NEAR(box->low.x, -0.25, 0.05);  // births lie within a step of the moment that is looked at
  EXPECT_NEAR(box->high.x, kTwoSeconds + 0.25, 0.05);
  EXPECT_NEAR(box->low.y, -0.25, kFloat);
  EXPECT_NEAR(box->high.z, 0.25, kFloat);
  system.emitters[0].rate = {{0.0, 0.0}};
  EXPECT_FALSE(motionBox(system, {24.0, 2, 0}, 48));
  system.boxMin = {-1, -2, -3};
  system.boxMax = {1, 2, 3};
  EXPECT_EQ(motionBox(system, {24.0, 2, 0}, 48)->low, system.boxMin);
}

}  // namespace
}  // namespace nephele
