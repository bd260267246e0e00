// The rules of `check`: a good file breaks none, and each fault breaks its own.
#include "volume/check.h"

#include <gtest/gtest.h>
#include <openvdb/tools/ChangeBackground.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "tests/scratch_folder.h"
#include "tests/volume/test_grids.h"
#include "volume/info.h"

namespace nephele {
namespace {

constexpr Audience kAll;

Provenance someProvenance() {
  Provenance provenance;
  provenance.recipeHash = "abc";
  provenance.hasMedium = true;
  return provenance;
}

Verdict verdictOf(const std::vector<Verdict>& verdicts, const std::string& name) {
  for (const Verdict& verdict : verdicts)
    if (verdict.name == name) return verdict;
  ADD_FAILURE() << "no rule " << name;
  return {};
}

/// Names of the rules that hold as asked.
std::string named(const std::vector<Verdict>& verdicts, Holds holds) {
  std::string names;
  for (const Verdict& verdict : verdicts)
    if (verdict.holds == holds) names += (names.empty() ? "" : ", ") + verdict.name;
  return names;
}

std::vector<Verdict> verdictsOnGrids(const openvdb::GridCPtrVec& grids, const Audience& audience = kAll,
                                     const std::string& name = "a.vdb") {
  const ScratchFolder scratch;
  writeVdb(scratch.file(name), grids, someProvenance());
  return checkFile(scratch.file(name), audience).verdicts;
}

TEST(Check, AGoodFileBreaksNoRule) {
  const auto velocity = makeVelocityGrid(0.1, true);
  velocity->fill(openvdb::CoordBBox({0, 0, 0}, {20, 20, 20}), openvdb::Vec3s(1.0f, 0.0f, 0.0f));
  velocity->tree().voxelizeActiveTiles();
  velocity->tree().setValueOn({1, 1, 1}, openvdb::Vec3s(2.0f, 0.0f, 0.0f));
  for (const auto& verdicts : {verdictsOnGrids({randomGrid({-3, 5, 8}, 20)}),
                               verdictsOnGrids({randomGrid({-3, 5, 8}, 20)}, audienceOf("blender"))}) {
    EXPECT_EQ(named(verdicts, Holds::no), "");
    EXPECT_EQ(named(verdicts, Holds::note), "");
    EXPECT_EQ(named(verdicts, Holds::notAsked), "half a voxel, late loading, same contents");
    EXPECT_EQ(verdicts.size(), 17u);
    for (size_t i = 0; i < verdicts.size(); ++i) {
      EXPECT_EQ(verdicts[i].rule, static_cast<int>(i) + 1);
      EXPECT_FALSE(verdicts[i].sentence.empty()) << verdicts[i].name;
    }
  }
  const auto both = verdictsOnGrids({randomGrid({0, 0, 0}, 20), velocity});
  EXPECT_EQ(named(both, Holds::no), "");
  EXPECT_EQ(verdictOf(both, "other grids").holds, Holds::yes) << verdictOf(both, "other grids").sentence;
}

TEST(Check, HashesNothing) {
  const ScratchFolder scratch;
  const std::string file = scratch.file("a.vdb");
  writeVdb(file, {randomGrid({0, 0, 0}, 20)}, someProvenance());
  EXPECT_EQ(factsOf(file).grids.at(0).info.contentHash, "");
  EXPECT_EQ(inspectFile(file).grids.at(0).contentHash.size(), 32u);
}

/// What broken(grid) makes of a good grid.
template <class Break>
std::vector<Verdict> verdictsOnBroken(const Break& broken, const Audience& audience = kAll) {
  const auto grid = randomGrid({0, 0, 0}, 20);
  broken(*grid);
  return verdictsOnGrids({grid}, audience);
}

TEST(Check, EachFaultOfAGridBreaksItsRule) {
  using Grid = openvdb::FloatGrid;
  const auto broken = [](const auto& change) { return named(verdictsOnBroken(change), Holds::no); };
  EXPECT_EQ(broken([](Grid& g) { g.setName("Density"); }), "density");
  EXPECT_EQ(broken([](Grid& g) { g.setGridClass(openvdb::GRID_LEVEL_SET); }), "density");
  EXPECT_EQ(broken([](Grid& g) { openvdb::tools::changeBackground(g.tree(), 0.5f); }), "density");
  EXPECT_EQ(broken([](Grid& g) {
              g.tree().setValueOn({3, 3, 3}, std::numeric_limits<float>::infinity());
            }),
            "values");
  EXPECT_EQ(broken([](Grid& g) {
              g.tree().setValueOff({25, 3, 3}, std::nanf(""));
            }),
            "values")
      << "box samplers read it";
  EXPECT_EQ(broken([](Grid& g) {
              for (auto value = g.beginValueOn(); value; ++value) value.setValue(1e-3f * *value);
            }),
            "scale");
  EXPECT_EQ(broken([](Grid& g) {
              g.clear();
              g.fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), 1.0f);
            }),
            "topology")
      << "Blender draws nothing of tiles alone";
  EXPECT_EQ(broken([](Grid& g) {
              g.setTransform(openvdb::math::Transform::createFrustumTransform(
                  openvdb::BBoxd({0, 0, 0}, {20, 20, 20}), 0.5, 2.0, 0.1));
            }),
            "linear");
}

TEST(Check, WhatIsWorthKnowingIsANote) {
  using Grid = openvdb::FloatGrid;
  const auto noted = [](const auto& change) { return named(verdictsOnBroken(change), Holds::note); };
  EXPECT_EQ(noted([](Grid& g) { g.setGridClass(openvdb::GRID_UNKNOWN); }), "density");
  EXPECT_EQ(noted([](Grid& g) { g.tree().setValueOn({3, 3, 3}, 70000.0f); }), "values");
  EXPECT_EQ(noted([](Grid& g) { g.tree().setValueOn({3, 3, 3}, 1e-9f); }), "values");
  EXPECT_EQ(noted([](Grid& g) { g.tree().setValueOn({3, 3, 3}, 0x1p-24f); }), "") << "the least half";
  EXPECT_EQ(noted([](Grid& g) { g.tree().touchLeaf({100, 0, 0}); }), "topology");
  EXPECT_EQ(noted([](Grid& g) {
              for (int i = 0; i < 512; ++i) g.tree().setValueOn({100 + i / 64 + 4, i / 8 % 8, i % 8}, 0.5f);
            }),
            "topology");
  EXPECT_EQ(noted([](Grid& g) { g.tree().setValueOn({3000, 0, 0}, 0.5f); }), "box");
  EXPECT_EQ(noted([](Grid& g) {
              for (auto value = g.beginValueOn(); value; ++value) value.setValue(0.02f * *value);
            }),
            "scale");
  EXPECT_EQ(noted([](Grid& g) { g.clear(); }), "empty grids");
}

TEST(Check, GridsAreHeldTogether) {
  const auto density = randomGrid({0, 0, 0}, 20), finer = randomGrid({0, 0, 0}, 20, 2);
  finer->setName("temperature");
  EXPECT_EQ(named(verdictsOnGrids({density, finer}), Holds::no), "");
  finer->setTransform(openvdb::math::Transform::createLinearTransform(0.05));
  EXPECT_EQ(named(verdictsOnGrids({density, finer}), Holds::no), "one transform");
  EXPECT_EQ(named(verdictsOnGrids({density, density->deepCopy()}), Holds::no), "density")
      << "two of one name";
  const auto speed = randomGrid({0, 0, 0}, 20);
  speed->setName("vel");
  EXPECT_EQ(named(verdictsOnGrids({density, speed}), Holds::no), "other grids") << "a velocity of one number";
  const auto velocity = makeVelocityGrid(0.1, false);
  velocity->tree().setValueOn({0, 0, 0}, openvdb::Vec3s(1.0f, 0.0f, 0.0f));
  velocity->setName("velocity");
  EXPECT_EQ(verdictOf(verdictsOnGrids({density, velocity}), "other grids").holds, Holds::note);
  EXPECT_EQ(verdictOf(verdictsOnGrids({density, velocity}, audienceOf("blender")), "other grids").holds,
            Holds::yes);
}

TEST(Check, EachProgramHasItsOwnRules) {
  EXPECT_TRUE(audienceOf("").blender && audienceOf("").houdini && audienceOf("").unreal);
  EXPECT_FALSE(audienceOf("houdini").blender);
  EXPECT_THROW(audienceOf("blend"), InputError);
  const auto tiles = [](openvdb::FloatGrid& g) {
    g.clear();
    g.fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), 1.0f);
  };
  EXPECT_EQ(named(verdictsOnBroken(tiles, audienceOf("blender")), Holds::no), "topology");
  EXPECT_EQ(named(verdictsOnBroken(tiles, audienceOf("unreal")), Holds::no), "");
  const auto houdini = verdictsOnBroken([](openvdb::FloatGrid&) {}, audienceOf("houdini"));
  EXPECT_EQ(verdictOf(houdini, "scale").holds, Holds::notAsked);
  EXPECT_EQ(verdictOf(houdini, "creator").holds, Holds::note) << "z is no axis that stands there";
}

TEST(Check, FramesAreHeldToTheirNeighbours) {
  const ScratchFolder scratch;
  const auto fileName = [&](const std::string& name) {
    return verdictOf(checkFile(scratch.file(name), kAll).verdicts, "file name");
  };
  Provenance frame = someProvenance();
  frame.frame = 9;
  write(scratch.file("puff_0009.vdb"), randomGrid({0, 0, 0}, 9), frame);
  EXPECT_EQ(fileName("puff_0009.vdb").holds, Holds::note) << "a lone number";
  std::filesystem::copy(scratch.file("puff_0009.vdb"), scratch.file("puff_0010.vdb"));
  EXPECT_EQ(fileName("puff_0010.vdb").sentence, "frames 9 to 10");
  EXPECT_EQ(fileName("puff_0010.vdb").holds, Holds::yes);
  std::filesystem::copy(scratch.file("puff_0009.vdb"), scratch.file("puff_0012.vdb"));
  EXPECT_EQ(fileName("puff_0009.vdb").sentence, "1 frames are missing from 9 to 12");
  EXPECT_EQ(fileName("puff_0009.vdb").holds, Holds::no);
  std::filesystem::copy(scratch.file("puff_0009.vdb"), scratch.file("puff_011.vdb"));
  EXPECT_EQ(fileName("puff_0009.vdb").sentence, "the numbers of its sequence are not padded to one width");
  std::filesystem::copy(scratch.file("puff_0009.vdb"), scratch.file("puff.vdb"));
  EXPECT_EQ(fileName("puff.vdb").holds, Holds::no) << "a frame without a number";
  std::filesystem::copy(scratch.file("puff_0009.vdb"), scratch.file("n\xc3\xa9.vdb"));
  EXPECT_NE(fileName("n\xc3\xa9.vdb").sentence.find("not ASCII"), std::string::npos);
}

TEST(Check, TreesThatNoReaderKnowsAreToldByTheHeadAlone) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({0, 0, 0}, 9), someProvenance());
  std::string whole = readWhole(scratch.file("a.vdb"));
  const size_t at = whole.find("Tree_float_5_4_3");
  ASSERT_NE(at, std::string::npos);
  whole.replace(at, 16, "Tree_halfs_5_4_3");
  const std::vector<Verdict> verdicts = checkFile(scratch.write("b.vdb", whole), kAll).verdicts;
  EXPECT_EQ(named(verdicts, Holds::no), "half");
  EXPECT_EQ(verdictOf(verdicts, "density").holds, Holds::notAsked);
  EXPECT_EQ(verdictOf(verdicts, "format").holds, Holds::yes);
}

TEST(Check, OnlyOurOwnFilesOweProvenance) {
  const ScratchFolder scratch;
  const openvdb::GridCPtrVec grids{randomGrid({0, 0, 0}, 9)};
  openvdb::MetaMap foreign;
  foreign.insertMeta("creator", openvdb::StringMetadata("Houdini 19"));
  writeGrids(scratch.file("foreign.vdb"), grids, foreign);
  const auto verdicts = checkFile(scratch.file("foreign.vdb"), kAll).verdicts;
  EXPECT_EQ(verdictOf(verdicts, "provenance").holds, Holds::notAsked);
  EXPECT_NE(verdictOf(verdicts, "creator").sentence.find("90 degrees"), std::string::npos);
  openvdb::MetaMap ours;
  ours.insertMeta("creator", openvdb::StringMetadata(creatorName()));
  writeGrids(scratch.file("ours.vdb"), grids, ours);
  EXPECT_EQ(named(checkFile(scratch.file("ours.vdb"), kAll).verdicts, Holds::no), "creator, provenance");
}

TEST(Check, CompressionIsReadFromEachGrid) {
  const ScratchFolder scratch;
  openvdb::initialize();
  openvdb::io::File file(scratch.file("a.vdb"));
  for (const auto& [flags, word] :
       {std::pair(openvdb::io::COMPRESS_NONE, "not compressed"),
        std::pair(openvdb::io::COMPRESS_ZIP, "not compressed"), std::pair(openvdb::io::COMPRESS_BLOSC, "")}) {
    file.setCompression(flags);
    file.write({randomGrid({0, 0, 0}, 9)});
    const Verdict format = verdictOf(checkFile(scratch.file("a.vdb"), kAll).verdicts, "format");
    EXPECT_EQ(format.holds, *word != 0 ? Holds::note : Holds::yes) << format.sentence;
    EXPECT_NE(format.sentence.find(word), std::string::npos) << format.sentence;
  }
}

TEST(Check, IsToldAsJson) {
  const FileCheck good{"a.vdb", {{1, "density", Holds::yes, "fine"}, {2, "b", Holds::notAsked, "why"}}};
  const FileCheck bad{"b.vdb", {{1, "density", Holds::no, "wrong"}}};
  EXPECT_TRUE(good.good());
  EXPECT_FALSE(bad.good());
  const auto json = nlohmann::json::parse(checksAsJson({good, bad}));
  EXPECT_EQ(json.at(0).at("rules").at(1).at("holds"), "not asked");
  EXPECT_EQ(json.at(1).at("good"), false);
  EXPECT_EQ(nlohmann::json::parse(checksAsJson({good})).at("path"), "a.vdb");
}

TEST(Check, AFrustumHasNoMatrix) {
  const ScratchFolder scratch;
  const auto grid = randomGrid({0, 0, 0}, 9);
  grid->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 2.0, 0.1));
  write(scratch.file("a.vdb"), grid);
  const FileInfo info = inspectFile(scratch.file("a.vdb"));
  EXPECT_FALSE(info.grids.at(0).linear);
  EXPECT_TRUE(nlohmann::json::parse(infoAsJson({info})).at("grids").at(0).at("transform").is_null());
  EXPECT_NE(infoAsText(info).find("frustum"), std::string::npos);
}

class CheckForeign : public testing::TestWithParam<const char*> {};

TEST_P(CheckForeign, FilesOfHoudiniOpenWell) {
  const std::string path = std::string(NEPHELE_TEST_DATA) + "/" + GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "left out: " << path << " is not there";
  const FileCheck check = checkFile(path, kAll);
  EXPECT_TRUE(check.good()) << checkAsText(check);
  EXPECT_EQ(named(check.verdicts, Holds::note), "creator");
  EXPECT_EQ(verdictOf(check.verdicts, "provenance").holds, Holds::notAsked);
}

INSTANTIATE_TEST_SUITE_P(Houdini, CheckForeign, testing::Values("pyro.vdb", "fogTommy.vdb"));

}  // namespace
}  // namespace nephele
