// The head of .vdb files: what it says of good ones, and that damaged ones are refused, never read beyond
// their end.
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "base/files.h"
#include "tests/scratch_folder.h"
#include "tests/volume/test_grids.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

std::string complaintOf(const std::string& path) {
  try {
    readVdbHeader(path);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(VdbHeader, ListsGridsAndMetadata) {
  const ScratchFolder scratch;
  const auto a = randomGrid({0, 0, 0}, 10), b = randomGrid({0, 0, 0}, 4);
  b->setSaveFloatAsHalf(true);
  const auto flags = openvdb::GridBase::createGrid(openvdb::BoolGrid::gridType());
  flags->setName("mask");
  writeVdb(scratch.file("a.vdb"), {a, b, flags}, {});
  const VdbHeader header = readVdbHeader(scratch.file("a.vdb"));
  EXPECT_GE(header.fileVersion, 220u);
  EXPECT_EQ(header.metadata.at("creator"), creatorName());
  EXPECT_EQ(header.metadata.at("up_axis"), "z");
  ASSERT_EQ(header.grids.size(), 3u);
  EXPECT_EQ(header.grids[0].name, "density");
  EXPECT_EQ(header.grids[1].name, "density");  // the number that tells them apart is taken off
  EXPECT_EQ(header.grids[0].type, openvdb::FloatGrid::gridType());
  EXPECT_EQ(header.grids[1].type, openvdb::FloatGrid::gridType());
  EXPECT_FALSE(header.grids[0].half);
  EXPECT_TRUE(header.grids[1].half);
  EXPECT_EQ(header.grids[2].type, openvdb::BoolGrid::gridType());
  EXPECT_LT(header.grids[0].begin, header.grids[0].end);
  EXPECT_EQ(header.grids[0].end, header.grids[1].begin);
  EXPECT_EQ(header.grids[2].end, header.sizeBytes);
  EXPECT_EQ(header.sizeBytes, std::filesystem::file_size(scratch.file("a.vdb")));
}

TEST(VdbHeader, RefusesEveryEarlyEnd) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({-3, 0, 5}, 8));
  const std::string whole = readWhole(scratch.file("a.vdb"));
  for (size_t length = 0; length < whole.size(); length += length < 2000 ? 1 : 97) {
    const std::string path = scratch.write("cut.vdb", whole.substr(0, length));
    EXPECT_THROW(readVdbHeader(path), InputError) << length;
  }
  EXPECT_EQ(complaintOf(scratch.write("cut.vdb", whole.substr(0, whole.size() - 1))),
            scratch.file("cut.vdb") + ": error: is cut short: its grids reach to byte " +
                std::to_string(whole.size()) + ", but the file has " + std::to_string(whole.size() - 1) +
                " bytes");
}

TEST(VdbHeader, RefusesWhatIsNoVdb) {
  const ScratchFolder scratch;
  EXPECT_EQ(complaintOf(scratch.file("no.vdb")), scratch.file("no.vdb") + ": error: no such file");
  EXPECT_EQ(complaintOf(scratch.path()), scratch.path() + ": error: is a folder, not a file");
  for (const char* junk : {"", "x", "not a volume at all, but longer than any head", "\x89PNG\r\n\x1a\n"})
    EXPECT_EQ(complaintOf(scratch.write("j.vdb", junk)), scratch.file("j.vdb") + ": error: is no .vdb file");
  const std::string old =
      std::string(" BDV\0\0\0\0", 8) + std::string("\xd0\0\0\0", 4) + std::string(200, '\0');
  EXPECT_EQ(complaintOf(scratch.write("o.vdb", old)),
            scratch.file("o.vdb") + ": error: is of .vdb version 208; versions from 220 on are read");
}

TEST(VdbHeader, RandomDamageIsRefusedOrReadButNeverWorse) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({0, 0, 0}, 3));
  const std::string whole = readWhole(scratch.file("a.vdb"));
  std::mt19937 random(7);
  constexpr size_t kHeadBytes = 600;
  int refused = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[8 + random() % (kHeadBytes - 8)] = static_cast<char>(random());
    try {
      readVdbHeader(scratch.write("d.vdb", damaged));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace nephele
