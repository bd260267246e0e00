// Damage inside a .vdb: flipped bits give a sentence or other values, never a crash; what is whole is let
// pass.
#include "volume/vdb_body.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "tests/scratch_folder.h"
#include "tests/volume/test_grids.h"

namespace nephele {
namespace {

std::string complaintOf(const std::string& path) {
  try {
    checkVdbBody(path, readVdbHeader(path));
  } catch (const InputError& error) {
    return error.diagnostics().front().sentence;
  }
  return "accepted";
}

TEST(VdbBody, LetsPassWhatIsWhole) {
  const ScratchFolder scratch;
  for (const bool half : {false, true}) {
    const auto grid = randomGrid({-100, 3, 8}, 40);
    grid->fill(openvdb::CoordBBox({128, 128, 128}, {255, 255, 255}), 0.25f);
    grid->tree().addTile(3, {8192, 0, 0}, 1.0f, true);  // at the root
    grid->tree().setValueOff({5, 5, 9}, 3.0f);          // an inactive value beside the background
    grid->setSaveFloatAsHalf(half);
    const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(
        openvdb::GridBase::createGrid(openvdb::Vec3SGrid::gridType()));
    vectors->tree().setValue({1, 2, 3}, {1.0f, 0.0f, 2.0f});
    vectors->setSaveFloatAsHalf(half);
    const std::string path = scratch.file("whole.vdb");
    writeVdb(path, {grid, vectors}, {});
    EXPECT_EQ(complaintOf(path), "accepted");
    initializeOpenVdb();
    for (const uint32_t compression :
         {0u, 1u, 2u, 3u, 4u, 6u}) {  // none, ZIP, mask, both, Blosc, Blosc and mask
      openvdb::io::File file(path);
      file.setCompression(compression);
      const auto sharing = grid->copy();  // one tree for both
      const auto tiles = makeFogGrid("tiles", 0.1, half);
      tiles->fill(openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), 0.25f);  // and no leaf
      file.write(openvdb::GridCPtrVec{grid, sharing, vectors, tiles});
      EXPECT_EQ(complaintOf(path), "accepted") << "compression " << compression;
      file.write(openvdb::GridCPtrVec{vectors});
      EXPECT_EQ(complaintOf(path), "accepted") << "vectors alone, compression " << compression;
    }
  }
}

TEST(VdbBody, FlippedBitsAreRefusedOrReadAndNeverCrash) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({-100, 3, 8}, 16));
  const std::string whole = readWhole(scratch.file("a.vdb"));
  const size_t body = readVdbHeader(scratch.file("a.vdb")).grids[0].grid;
  constexpr size_t kEvery = 101;  // bytes; prime, so that no field of a record is always missed
  int refused = 0, readable = 0;
  for (size_t n = body; n < whole.size(); n += kEvery) {
    std::string flipped = whole;
    flipped[n] = char(flipped[n] ^ (1 << (n % 8)));
    const std::string path = scratch.write("flipped.vdb", flipped);
    try {
      readVdb(path);
      ++readable;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 30);
  EXPECT_GT(readable, 0);
}

TEST(VdbBody, NamesTheGridThePlaceAndTheFault) {
  const ScratchFolder scratch;
  write(scratch.file("a.vdb"), randomGrid({0, 0, 0}, 16));
  const std::string whole = readWhole(scratch.file("a.vdb"));
  const VdbGridEntry entry = readVdbHeader(scratch.file("a.vdb")).grids[0];
  // The first leaf's buffer: its mask, how inactive values are told, the block's size in 8 bytes, the block.
  constexpr size_t kKindAt = 64, kSizeAt = 65;
  const auto damaged = [&](size_t at, char to) {
    std::string bytes = whole;
    bytes[at] = to;
    return complaintOf(scratch.write("damaged.vdb", bytes));
  };
  const std::string place = "is damaged: in grid 'density' at byte ";
  EXPECT_EQ(damaged(entry.blocks + kKindAt, '\x40').rfind(place, 0), 0u);
  EXPECT_NE(damaged(entry.blocks + kKindAt, '\x40').find("told in an unknown way"), std::string::npos);
  // A negative size says that the block is not compressed; OpenVDB would read that many bytes over its
  // buffer.
  EXPECT_NE(damaged(entry.blocks + kSizeAt + 7, '\xff').find("a block does not hold"), std::string::npos);
  EXPECT_NE(damaged(entry.blocks + kSizeAt + 5, '\x01').find("beyond its end"), std::string::npos);
  EXPECT_NE(damaged(entry.grid + 3, '\x01').find("its compression is unknown"), std::string::npos);
}

}  // namespace
}  // namespace nephele
