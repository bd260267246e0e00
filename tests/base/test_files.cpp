// Files appear whole or not at all, and what dead writers left goes.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

void put(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

TEST(Files, WritesWhole) {
  const ScratchFolder scratch;
  std::string seen;
  writeWhole(scratch.file("a.vdb"), [&](const std::string& temporary) {
    seen = temporary;
    put(temporary, "content");
    EXPECT_FALSE(std::filesystem::exists(scratch.file("a.vdb")));
  });
  EXPECT_EQ(seen, scratch.file(".a.vdb." + std::to_string(::getpid()) + ".partial"));
  EXPECT_EQ(readWhole(scratch.file("a.vdb")), "content");
  EXPECT_EQ(scratch.fileCount(), 1);
}

TEST(Files, AFailingWriterLeavesTheOldFileAndNothingElse) {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.vdb", "old");
  const auto fail = [](const std::string& temporary) {
    put(temporary, "half");
    throw WorldError("disk full");
  };
  EXPECT_THROW(writeWhole(path, fail), WorldError);
  EXPECT_EQ(readWhole(path), "old");
  EXPECT_EQ(scratch.fileCount(), 1);
}

TEST(Files, FoldersThatCannotBeWrittenAreTheWorldsFault) {
  const ScratchFolder scratch;
  const auto write = [](const std::string& temporary) { put(temporary, "x"); };
  EXPECT_THROW(writeWhole(scratch.file("missing/a.vdb"), write), WorldError);
  EXPECT_THROW(writeWhole(scratch.path(), write), WorldError);
  EXPECT_THROW(writeWhole(scratch.file("a.vdb"), [](const std::string&) {}), WorldError);
  EXPECT_EQ(scratch.fileCount(), 0);
}

TEST(Files, LeftoversOfTheDeadGoAndOfTheLivingStay) {
  const ScratchFolder scratch;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);  // from here on nobody has its number
  scratch.write(".a.vdb." + std::to_string(child) + ".partial", "x");
  scratch.write(".b.c.vdb." + std::to_string(child) + ".partial", "x");
  const std::string alive = scratch.write(".a.vdb." + std::to_string(::getpid()) + ".partial", "x");
  const std::string foreign[] = {scratch.write("a.partial", "x"), scratch.write(".a.vdb.12x.partial", "x"),
                                 scratch.write(".partial", "x"), scratch.write(".a.vdb", "x"),
                                 scratch.write("a.vdb." + std::to_string(child) + ".partial", "x")};
  EXPECT_EQ(removeLeftovers(scratch.path()), 2);
  EXPECT_TRUE(std::filesystem::exists(alive));
  for (const std::string& path : foreign) EXPECT_TRUE(std::filesystem::exists(path)) << path;
  EXPECT_EQ(removeLeftovers(scratch.path()), 0);
  EXPECT_EQ(removeLeftovers(scratch.file("missing")), 0);
}

TEST(Files, ReadsWhole) {
  const ScratchFolder scratch;
  const std::string content("a\0b\nc", 5);
  EXPECT_EQ(readWhole(scratch.write("a", content)), content);
  const std::string large(3000001, 'x');  // more than one piece
  EXPECT_EQ(readWhole(scratch.write("large", large)), large);
  EXPECT_EQ(readWhole(scratch.write("empty", "")), "");
  EXPECT_THROW(readWhole(scratch.file("missing")), InputError);
  EXPECT_THROW(readWhole(scratch.path()), InputError);
}

}  // namespace
}  // namespace nephele
