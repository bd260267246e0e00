// The document: opening, refusing, reloading, playing over a bad frame; with real files and no window.
#include "preview/app/document.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/scratch_folder.h"

namespace nephele {
namespace {

/// Files hold their volume's density as text; a "bad" one cannot be read.
BrickVolume loadText(const VolumeKey& key) {
  std::ifstream in(key.path);
  double density = 0.0;
  if (!(in >> density)) throw std::runtime_error(key.path + ": error: cannot be read");
  BrickVolume volume;
  volume.path = key.path;
  volume.gridName = key.grid.empty() ? "density" : key.grid;
  volume.maximum = density;
  volume.metadata["heat"] = key.heat;
  return volume;
}

struct OpenFile {
  ReadAhead reader;
  Document document;
  std::string lastNotice;

  explicit OpenFile(const std::string& path)
      : reader(
            loadText, [] {}, 1 << 20),
        document({path, ""}, std::make_shared<const BrickVolume>(loadText({path, ""})), stampOf(path),
                 reader) {}

  /// Turns of the loop until there is news; at most ten seconds.
  DocumentNews waitForNews(bool watching = false) {
    for (int i = 0; i < 5000; ++i) {
      if (watching) document.lookAtFiles();
      DocumentNews news = document.advance(0.002);
      if (news.volume || !news.notice.empty()) return news;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ADD_FAILURE() << "no news";
    return {};
  }
};

TEST(Document, OpensAnotherFile) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  open.document.open(folder.write("b.vdb", "2"));
  const DocumentNews news = open.waitForNews();
  ASSERT_TRUE(news.volume);
  EXPECT_EQ(news.volume->maximum, 2.0);
  EXPECT_TRUE(news.otherFile);
  EXPECT_EQ(news.notice, "opened b.vdb");
}

TEST(Document, TemperaturesComeFromAnotherGrid) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  open.document.chooseHeat("fire");
  EXPECT_EQ(open.document.heat(), "fire");
  const DocumentNews news = open.waitForNews();
  ASSERT_TRUE(news.volume);
  EXPECT_EQ(news.volume->metadata.at("heat"), "fire");
  EXPECT_FALSE(news.otherFile);
  EXPECT_EQ(news.notice, "temperatures from grid 'fire'");
  folder.write("a.vdb", "2");  // which a reload asks for again
  EXPECT_EQ(open.waitForNews(true).volume->metadata.at("heat"), "fire");
}

TEST(Document, AWrongFileLeavesTheOld) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  open.document.open(folder.write("b.vdb", "nonsense"));
  const DocumentNews news = open.waitForNews();
  EXPECT_FALSE(news.volume);
  EXPECT_NE(news.notice.find("b.vdb: error: cannot be read"), std::string::npos);
  EXPECT_NE(news.notice.find("a.vdb stays"), std::string::npos);
  EXPECT_EQ(open.document.volume().maximum, 1.0);
}

TEST(Document, ShowsAFileThatWasBakedAgain) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  folder.write("a.vdb", "25");
  const DocumentNews news = open.waitForNews(true);
  ASSERT_TRUE(news.volume);
  EXPECT_EQ(news.volume->maximum, 25.0);
  EXPECT_FALSE(news.otherFile);
  EXPECT_EQ(news.notice, "read a.vdb again");
}

TEST(Document, KeepsTheOldWhereTheNewDoesNotLoad) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  folder.write("a.vdb", "cut short");
  const DocumentNews news = open.waitForNews(true);
  EXPECT_FALSE(news.volume);
  EXPECT_NE(news.notice.find("what was read before stays"), std::string::npos);
  EXPECT_EQ(open.document.volume().maximum, 1.0);
  folder.write("a.vdb", "333");
  EXPECT_EQ(open.waitForNews(true).volume->maximum, 333.0);
}

TEST(Document, PlaysOverABadFrame) {
  const ScratchFolder folder;
  const std::string first = folder.write("s_0001.vdb", "1");
  folder.write("s_0002.vdb", "bad");
  folder.write("s_0003.vdb", "3");
  OpenFile open(first);
  ASSERT_EQ(open.document.timeline().frames(), 3);
  open.document.timeline().setFps(60.0);
  open.document.timeline().play(true);
  const DocumentNews bad = open.waitForNews();
  EXPECT_FALSE(bad.volume);
  EXPECT_NE(bad.notice.find("s_0002.vdb: error"), std::string::npos);
  const DocumentNews good = open.waitForNews();
  ASSERT_TRUE(good.volume);
  EXPECT_EQ(good.volume->maximum, 3.0);
  EXPECT_TRUE(open.document.timeline().playing());
}

TEST(Document, FindsFramesThatAppear) {
  const ScratchFolder folder;
  OpenFile open(folder.write("s_0005.vdb", "5"));
  folder.write("s_0004.vdb", "4");
  for (int i = 0; i < 500 && open.document.timeline().frames() < 2; ++i) {
    open.document.lookAtFiles();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(open.document.timeline().frames(), 2);
  EXPECT_EQ(open.document.timeline().shown(), 1);
}

TEST(Document, ChangesTheGridAndKeepsTheFile) {
  const ScratchFolder folder;
  OpenFile open(folder.write("a.vdb", "1"));
  open.document.chooseGrid("heat");
  const DocumentNews news = open.waitForNews();
  ASSERT_TRUE(news.volume);
  EXPECT_EQ(news.volume->gridName, "heat");
  EXPECT_FALSE(news.otherFile);
}

TEST(FileWatch, ReportsAChangeOnceItHasSettled) {
  std::optional<FileStamp> stamp = FileStamp{1, 10, 7};
  FileWatch watch("a", stamp, [&](const std::string&) { return stamp; });
  EXPECT_FALSE(watch.poll());
  stamp->sizeBytes = 20;  // being written
  EXPECT_FALSE(watch.poll());
  stamp->sizeBytes = 30;
  EXPECT_FALSE(watch.poll());
  EXPECT_TRUE(watch.poll());
  EXPECT_FALSE(watch.poll());
}

TEST(FileWatch, WaitsForAMissingFile) {
  std::optional<FileStamp> stamp = FileStamp{1, 10, 7};
  FileWatch watch("a", stamp, [&](const std::string&) { return stamp; });
  stamp.reset();
  EXPECT_FALSE(watch.poll());
  EXPECT_FALSE(watch.poll());
  stamp = FileStamp{1, 10, 7};  // moved away and back: nothing new
  watch.poll();
  EXPECT_FALSE(watch.poll());
  stamp = FileStamp{1, 10, 8};  // another file of the same size and time
  watch.poll();
  EXPECT_TRUE(watch.poll());
}

TEST(FileWatch, SeesWhatHappenedBeforeItWasMade) {
  const std::optional<FileStamp> read = FileStamp{1, 10, 7}, now = FileStamp{2, 10, 7};
  FileWatch watch("a", read, [&](const std::string&) { return now; });
  watch.poll();
  EXPECT_TRUE(watch.poll());
}

}  // namespace
}  // namespace nephele
