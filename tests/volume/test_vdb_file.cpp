// Writing, reading, content hashes and info.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "tests/scratch_folder.h"
#include "tests/volume/test_grids.h"
#include "volume/info.h"
#include "volume/metadata.h"

namespace nephele {
namespace {

openvdb::GridBase::Ptr readBack(const std::string& path) { return readVdb(path).grids->at(0); }

TEST(VdbFile, ContentSurvivesTheDisk) {
  const ScratchFolder scratch;
  const auto grid = randomGrid({-100, 3, 8}, 40);
  grid->fill(openvdb::CoordBBox({128, 128, 128}, {255, 255, 255}), 0.25f);  // a tile of the middle level
  ASSERT_GT(grid->tree().activeTileCount(), 0u);
  const uint64_t bytes = writeVdb(scratch.file("a.vdb"), {grid}, {});
  EXPECT_EQ(bytes, std::filesystem::file_size(scratch.file("a.vdb")));
  EXPECT_EQ(contentHash(*readBack(scratch.file("a.vdb"))), contentHash(*grid));
  EXPECT_EQ(contentHash(*grid).size(), 32u);
  EXPECT_EQ(scratch.fileCount(), 1);
}

TEST(VdbFile, NumbersAreAddedToItsMetadataAndAllElseStays) {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.vdb");
  const auto grid = randomGrid({-100, 3, 8}, 20);
  const auto velocity = makeVelocityGrid(0.1, true);
  velocity->fill(openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}), openvdb::Vec3s(1.0f, 2.0f, 0.25f));
  Provenance provenance;
  provenance.recipeHash = "abc";
  writeVdb(path, {grid, velocity}, provenance);
  auto before = metadataAsText(*readVdb(path).metadata);
  addMetadata(path, {{"octaves_a", std::vector{0.25}}, {"octaves_b", std::vector{0.5, 0.25, 1.0}}});
  addMetadata(path, {{"octaves_a", std::vector{0.75}}});
  const VdbContents after = readVdb(path);
  before["octaves_a"] = "0.75";
  before["octaves_b"] = "[0.5, 0.25, 1]";
  EXPECT_EQ(metadataAsText(*after.metadata), before);
  ASSERT_EQ(after.grids->size(), 2u);
  EXPECT_EQ(contentHash(*after.grids->at(0)), contentHash(*grid));
  EXPECT_EQ(contentHash(*after.grids->at(1)), contentHash(*velocity));
  EXPECT_TRUE(after.grids->at(1)->saveFloatAsHalf());
  EXPECT_EQ(scratch.fileCount(), 1);
  EXPECT_THROW(addMetadata(scratch.file("nowhere.vdb"), {{"a", std::vector{1.0}}}), InputError);
}

/// The file's bytes from its first transform on: all that has neither a random number nor the hints for
/// loading by pieces, which OpenVDB's own writer adds.
std::string fromTransform(const std::string& path) {
  const std::string whole = readWhole(path);
  const size_t at = whole.find("ScaleMap");
  EXPECT_NE(at, std::string::npos);
  return whole.substr(at);
}

TEST(VdbFile, TreesAreWrittenByteForByteAsOpenVdbWritesThem) {
  const ScratchFolder scratch;
  const auto holed = randomGrid({-60, 3, 8}, 60);  // over 500 leaves: several pieces of work
  for (int n = 0; n < 40000; ++n)                  // some inactive at 0, some at other values
    holed->tree().setValueOff({n % 60 - 60, n / 60 % 60 + 3, n / 3600 + 8}, n % 7 == 0 ? 0.5f : 0.0f);
  holed->fill(openvdb::CoordBBox({128, 128, 128}, {255, 255, 255}), 0.25f);
  const auto half = holed->deepCopy();
  half->setSaveFloatAsHalf(true);
  const auto velocity = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  velocity->setTransform(holed->transformPtr());
  velocity->fill(openvdb::CoordBBox({0, 0, 0}, {20, 20, 20}), openvdb::Vec3s(1.0f, -2.0f, 0.25f));
  const auto empty = makeFogGrid("empty", 0.1, false);
  for (const openvdb::GridBase::Ptr& grid :
       std::initializer_list<openvdb::GridBase::Ptr>{holed, half, velocity, empty}) {
    write(scratch.file("ours.vdb"), grid);
    openvdb::io::File file(scratch.file("theirs.vdb"));
    file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(openvdb::GridCPtrVec{grid});
    file.close();
    EXPECT_TRUE(fromTransform(scratch.file("ours.vdb")) == fromTransform(scratch.file("theirs.vdb")))
        << grid->type();
  }
}

TEST(VdbFile, ManyGridsEachFindTheirOwnLeaves) {
  const ScratchFolder scratch;
  const auto a = randomGrid({0, 0, 0}, 40, 1), b = randomGrid({5, 0, -70}, 30, 2);
  b->setName("temperature");
  writeVdb(scratch.file("a.vdb"), {a, b, randomGrid({0, 0, 0}, 9, 3)}, {});
  const auto back = readVdb(scratch.file("a.vdb")).grids;
  ASSERT_EQ(back->size(), 3u);
  EXPECT_EQ(contentHash(*back->at(0)), contentHash(*a));
  EXPECT_EQ(contentHash(*back->at(1)), contentHash(*randomGrid({0, 0, 0}, 9, 3)));  // by name
  EXPECT_EQ(contentHash(*back->at(2)), contentHash(*b));
}

TEST(VdbFile, ProvenanceIsMetadata) {
  const ScratchFolder scratch;
  Provenance provenance;
  provenance.upAxis = 'y';
  provenance.recipeHash = "abc";
  provenance.seed = -5000000000;
  provenance.frame = 12;
  provenance.hasMedium = true;
  provenance.sigmaS = {0.1, 2.0, 1.0 / 3.0};
  provenance.sigmaA = {0.0, 0.5, 1e-9};
  provenance.g = 0.123456789012;
  const auto grid = randomGrid({0, 0, 0}, 2);
  write(scratch.file("a.vdb"), grid, provenance);
  const FileInfo info = inspectFile(scratch.file("a.vdb"));
  const std::map<std::string, std::string> expected{
      {"creator", creatorName()},     {"up_axis", "y"},       {"recipe_hash", "abc"},
      {"seed", "-5000000000"},        {"frame", "12"},        {"sigma_s", "[0.1, 2, 0.3333333333333333]"},
      {"sigma_a", "[0, 0.5, 1e-09]"}, {"g", "0.123456789012"}};
  EXPECT_EQ(info.metadata, expected);
  EXPECT_EQ(info.grids[0].metadata.count("file_delayed_load"), 0u);
  write(scratch.file("b.vdb"), grid);
  EXPECT_EQ(inspectFile(scratch.file("b.vdb")).metadata.count("sigma_s"), 0u);
  EXPECT_EQ(creatorName().rfind("Nephele ", 0), 0u);
}

TEST(VdbFile, WhatCannotBeWrittenLeavesNothing) {
  const ScratchFolder scratch;
  EXPECT_THROW(write(scratch.file("missing/a.vdb"), randomGrid({0, 0, 0}, 2)), WorldError);
  EXPECT_EQ(scratch.fileCount(), 0);
}

TEST(VdbFile, AFullDiskLeavesNothing) {
  const ScratchFolder scratch;
  const auto grid = randomGrid({0, 0, 0}, 32);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  constexpr rlim_t kRoomBytes = 20000;  // the grid takes about 130 kB
  const rlimit full{kRoomBytes, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THROW(write(scratch.file("a.vdb"), grid), WorldError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(scratch.fileCount(), 0);
}

TEST(VdbFile, DamagedContentIsTheUsersFault) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({0, 0, 0}, 16));
  const std::string whole = readWhole(scratch.file("a.vdb"));
  EXPECT_THROW(readVdb(scratch.write("cut.vdb", whole.substr(0, whole.size() / 2))), InputError);
  EXPECT_THROW(readVdb(scratch.file("missing.vdb")), InputError);
  std::string unknownType = whole;
  const size_t at = unknownType.find("Tree_float");
  unknownType[at + 5] = 'q';
  EXPECT_THROW(readVdb(scratch.write("type.vdb", unknownType)), InputError);
}

TEST(ContentHash, SeesWhatMatters) {
  const auto grid = randomGrid({0, 0, 0}, 20);
  const std::string hash = contentHash(*grid);
  const auto changed = [&](auto change) {
    const auto copy = grid->deepCopy();
    change(*copy);
    return contentHash(*copy) != hash;
  };
  EXPECT_FALSE(changed([](openvdb::FloatGrid&) {}));
  EXPECT_TRUE(changed([](auto& g) { g.setName("smoke"); }));
  EXPECT_TRUE(changed([](auto& g) { g.setGridClass(openvdb::GRID_UNKNOWN); }));
  EXPECT_TRUE(changed([](auto& g) { g.setTransform(openvdb::math::Transform::createLinearTransform(0.2)); }));
  EXPECT_TRUE(changed([](auto& g) { g.tree().setValue({3, 3, 3}, 7.0f); }));
  EXPECT_TRUE(changed([](auto& g) { g.tree().setActiveState({3, 3, 3}, false); }));
  EXPECT_TRUE(changed([](auto& g) { g.tree().setValueOff({23, 3, 3}, 1.0f); }));  // a sampler reads it
  EXPECT_TRUE(changed([](auto& g) { g.tree().setValue({500, 0, 0}, 1.0f); }));
  EXPECT_TRUE(changed([](auto& g) { g.tree().addTile(1, {800, 0, 0}, 1.0f, true); }));
  EXPECT_FALSE(changed([](auto& g) { g.tree().addTile(1, {800, 0, 0}, 1.0f, false); }));
  EXPECT_FALSE(changed([](auto& g) {
    g.tree().setValueOff({800, 0, 0}, 1.0f);
  }));  // a leaf that nothing reads
  EXPECT_FALSE(changed([](auto& g) { g.insertMeta("note", openvdb::StringMetadata("x")); }));
}

TEST(ContentHash, MinusZeroIsZero) {
  const auto plus = randomGrid({0, 0, 0}, 4), minus = randomGrid({0, 0, 0}, 4);
  plus->tree().setValue({1, 1, 1}, 0.0f);
  minus->tree().setValue({1, 1, 1}, -0.0f);
  plus->tree().addTile(1, {80, 0, 0}, 0.0f, true);
  minus->tree().addTile(1, {80, 0, 0}, -0.0f, true);
  EXPECT_EQ(contentHash(*plus), contentHash(*minus));
  const auto empty = [] { return openvdb::GridBase::createGrid(openvdb::Vec3SGrid::gridType()); };
  const auto a = openvdb::gridPtrCast<openvdb::Vec3SGrid>(empty()),
             b = openvdb::gridPtrCast<openvdb::Vec3SGrid>(empty());
  a->tree().setValue({0, 0, 0}, {1.0f, 0.0f, 2.0f});
  b->tree().setValue({0, 0, 0}, {1.0f, -0.0f, 2.0f});
  EXPECT_EQ(contentHash(*a), contentHash(*b));
  b->tree().setValue({0, 0, 0}, {1.0f, 0.5f, 2.0f});
  EXPECT_NE(contentHash(*a), contentHash(*b));
}

TEST(ContentHash, IsTheSameOnAnyNumberOfThreadsAndInAnyOrderOfFilling) {
  const auto grid = randomGrid({-64, -64, -64}, 90);
  std::vector<std::string> hashes;
  for (const size_t threads : {size_t{1}, size_t{2}, size_t{7}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    hashes.push_back(contentHash(*grid));
  }
  auto reversed = makeFogGrid("density", 0.1, false);
  std::vector<openvdb::Coord> order;
  for (auto value = grid->cbeginValueOn(); value; ++value) order.push_back(value.getCoord());
  auto from = grid->getConstAccessor();
  auto to = reversed->getAccessor();
  for (auto c = order.rbegin(); c != order.rend(); ++c) to.setValue(*c, from.getValue(*c));
  hashes.push_back(contentHash(*reversed));
  for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(ContentHash, IsThatOfThePrunedTree) {
  const auto hashOf = [](bool voxelized, float last) {
    const auto grid = randomGrid({-8, -8, -8}, 20);
    // Tiles of 8, 128 and 4096 voxels, and the last voxel of the largest.
    grid->tree().addTile(1, {-64, 0, 0}, 0.25f, true);
    grid->tree().addTile(2, {-256, 0, 0}, 0.5f, true);
    grid->tree().addTile(3, {4096, 0, 0}, 2.0f, true);
    if (voxelized) {
      grid->tree().touchLeaf({-64, 0, 0});
      grid->tree().touchLeaf({-200, 50, 50});
      grid->tree().touchLeaf({5000, 300, 300});
      EXPECT_GT(grid->tree().leafCount(), randomGrid({-8, -8, -8}, 20)->tree().leafCount() + 2);
    }
    if (last != 2.0f) grid->tree().setValue({8191, 4095, 4095}, last);
    return contentHash(*grid);
  };
  EXPECT_EQ(hashOf(false, 2.0f), hashOf(true, 2.0f));
  EXPECT_EQ(hashOf(false, 2.5f), hashOf(true, 2.5f));
  EXPECT_NE(hashOf(true, 2.0f), hashOf(true, 2.5f));
}

TEST(ContentHash, EveryUsualTypeHasOneAndPointsHaveNone) {
  initializeOpenVdb();
  // By name from OpenVDB's table: making them by type would instantiate each anew, at seconds of compilation.
  const std::string types[] = {
      openvdb::FloatGrid::gridType(), openvdb::DoubleGrid::gridType(), openvdb::Int32Grid::gridType(),
      openvdb::Int64Grid::gridType(), openvdb::BoolGrid::gridType(),   openvdb::MaskGrid::gridType(),
      openvdb::Vec3SGrid::gridType(), openvdb::Vec3DGrid::gridType(),  openvdb::Vec3IGrid::gridType()};
  std::set<std::string> hashes;
  for (const std::string& type : types) hashes.insert(contentHash(*openvdb::GridBase::createGrid(type)));
  EXPECT_EQ(hashes.size(), std::size(types));  // the type is part of it
  EXPECT_EQ(hashes.count(""), 0u);
  const auto flags = openvdb::gridPtrCast<openvdb::BoolGrid>(openvdb::GridBase::createGrid(types[4]));
  flags->tree().setValue({1, 2, 3}, true);
  const std::string hash = contentHash(*flags);
  flags->tree().setValue({1, 2, 4}, true);
  EXPECT_NE(contentHash(*flags), hash);
  EXPECT_EQ(contentHash(*openvdb::GridBase::createGrid("Tree_ptdataidx32_5_4_3")), "");
}

TEST(Info, NumbersOfAKnownGrid) {
  const ScratchFolder scratch;
  const auto grid = makeFogGrid("density", 0.5, true);
  grid->denseFill(openvdb::CoordBBox({-2, 0, 1}, {7, 4, 3}), 1.0f);
  grid->tree().addTile(1, {3000, 0, 0}, 1.0f, true);
  write(scratch.file("a.vdb"), grid);
  const FileInfo info = inspectFile(scratch.file("a.vdb"));
  const GridInfo& g = info.grids.at(0);
  EXPECT_EQ(g.name, "density");
  EXPECT_EQ(g.type, "float");
  EXPECT_EQ(g.gridClass, "fog volume");
  EXPECT_TRUE(g.half);
  EXPECT_EQ(g.activeVoxels, 10u * 5u * 3u + 512u);
  EXPECT_EQ(g.leaves, 2u);
  EXPECT_EQ(g.tiles, 1u);
  EXPECT_EQ(g.boxMin, glm::ivec3(-2, 0, 0));
  EXPECT_EQ(g.boxMax, glm::ivec3(3008, 8, 8));
  EXPECT_EQ(g.denseBytes, 3010u * 8u * 8u * 4u);
  EXPECT_EQ(g.worldFromIndex[0][0], 0.5);
  const std::string text = infoAsText(info);
  EXPECT_NE(text.find("warning: 3010 voxels along x, above 2048"), std::string::npos) << text;
  EXPECT_EQ(text.find("empty"), std::string::npos);
}

TEST(Info, JsonHasTheContractsKeys) {
  const ScratchFolder scratch;
  const auto grid = makeFogGrid("density", 0.5, false);
  grid->transform().postTranslate({1.0, 2.0, 3.0});
  write(scratch.file("a.vdb"), grid);
  const FileInfo info = inspectFile(scratch.file("a.vdb"));
  const auto json = nlohmann::json::parse(infoAsJson({info}));
  EXPECT_EQ(json.at("path"), scratch.file("a.vdb"));
  EXPECT_EQ(json.at("file_bytes"), std::filesystem::file_size(scratch.file("a.vdb")));
  const auto g = json.at("grids").at(0);
  for (const char* key : {"name", "type", "class", "voxels_active", "leaves", "tiles", "box_min", "box_max",
                          "transform", "bytes", "dense_bytes", "content_hash", "metadata", "half"})
    EXPECT_TRUE(g.contains(key)) << key;
  EXPECT_EQ(g.at("transform"), nlohmann::json::parse("[[0.5,0,0,1],[0,0.5,0,2],[0,0,0.5,3],[0,0,0,1]]"));
  EXPECT_EQ(g.at("box_min"), g.at("box_max"));
  EXPECT_EQ(g.at("dense_bytes"), 0);
  EXPECT_EQ(nlohmann::json::parse(infoAsJson({info, info})).size(), 2u);
  EXPECT_NE(infoAsText(info).find("warning: the grid is empty"), std::string::npos);
}

}  // namespace
}  // namespace nephele
