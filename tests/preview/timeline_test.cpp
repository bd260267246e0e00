// Sequences on disk, time on them, and reading ahead with a faked reader.
#include "preview/app/timeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>

#include "preview/app/read_ahead.h"
#include "preview/app/sequence_files.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

std::vector<int> numbersOf(const std::vector<SequenceFrame>& frames) {
  std::vector<int> numbers;
  for (const SequenceFrame& frame : frames) numbers.push_back(frame.number);
  return numbers;
}

TEST(SequenceFiles, TakesNeighboursInOrder) {
  const ScratchFolder folder;
  for (const char* name : {"smoke_0003.vdb", "smoke_0001.vdb", "smoke_0010.vdb", "fire_0002.vdb",
                           "smoke_0002.png", "smoke_.vdb", "smoke_0004_old.vdb", ".smoke_0005.vdb.1.partial"})
    folder.write(name, "");
  const auto frames = findSequence(folder.file("smoke_0003.vdb"));
  EXPECT_EQ(numbersOf(frames), (std::vector<int>{1, 3, 10}));
  EXPECT_EQ(frames[0].path, folder.file("smoke_0001.vdb"));
  EXPECT_EQ(positionOf(frames, folder.file("smoke_0010.vdb")), 2);
}

TEST(SequenceFiles, NumbersMayOutgrowTheirZeros) {
  const ScratchFolder folder;
  for (const char* name : {"a_098.vdb", "a_099.vdb", "a_100.vdb", "a_1000.vdb", "a_0101.vdb", "a_7.vdb"})
    folder.write(name, "");
  EXPECT_EQ(numbersOf(findSequence(folder.file("a_099.vdb"))), (std::vector<int>{98, 99, 100, 1000}));
  // Seen from the wide one the padding is not known: what could be of its sequence is.
  EXPECT_EQ(numbersOf(findSequence(folder.file("a_1000.vdb"))).back(), 1000);
}

TEST(SequenceFiles, WithoutANumberAFileStandsAlone) {
  const ScratchFolder folder;
  folder.write("cumulus.vdb", "");
  folder.write("cumulus2.vdb", "");
  const auto frames = findSequence(folder.file("cumulus.vdb"));
  EXPECT_EQ(frames, (std::vector<SequenceFrame>{{0, folder.file("cumulus.vdb")}}));
  EXPECT_EQ(findSequence(folder.file("n_12345678901234.vdb")).size(), 1u);
}

TEST(SequenceFiles, AMissingFolderIsEmpty) { EXPECT_EQ(findSequence("/nowhere/a_0001.vdb").size(), 1u); }

FrameState allReady(int) { return FrameState::ready; }

TEST(Timeline, PlaysAtItsRateAndRound) {
  Timeline timeline(3, 0);
  timeline.setFps(10.0);
  timeline.play(true);
  EXPECT_FALSE(timeline.advance(0.05, allReady).show);
  EXPECT_EQ(timeline.advance(0.06, allReady).show, 1);
  EXPECT_EQ(timeline.advance(0.1, allReady).show, 2);
  EXPECT_EQ(timeline.advance(0.1, allReady).show, 0);
  EXPECT_EQ(timeline.shown(), 0);
}

TEST(Timeline, WaitsForAFrameThatIsBeingRead) {
  Timeline timeline(3, 0);
  timeline.setFps(10.0);
  timeline.play(true);
  bool there = false;
  const auto state = [&](int) { return there ? FrameState::ready : FrameState::pending; };
  EXPECT_FALSE(timeline.advance(0.1, state).show);
  EXPECT_TRUE(timeline.waiting());
  EXPECT_EQ(timeline.shown(), 0);
  EXPECT_FALSE(timeline.advance(5.0, state).show);
  there = true;
  EXPECT_EQ(timeline.advance(0.0, state).show, 1);
  // Of the time spent waiting one frame's is made up, no more.
  EXPECT_EQ(timeline.advance(0.0, state).show, 2);
  EXPECT_FALSE(timeline.advance(0.0, state).show);
}

TEST(Timeline, PassesOverABadFrameAndGoesOn) {
  Timeline timeline(4, 0);
  timeline.setFps(10.0);
  timeline.play(true);
  const auto state = [](int frame) { return frame == 1 ? FrameState::bad : FrameState::ready; };
  const auto turn = timeline.advance(0.1, state);
  EXPECT_EQ(turn.bad, 1);
  EXPECT_FALSE(turn.show);
  EXPECT_EQ(timeline.shown(), 0);
  EXPECT_TRUE(timeline.playing());
  EXPECT_EQ(timeline.advance(0.1, state).show, 2);
}

TEST(Timeline, SeekingStopsAndReportsOnce) {
  Timeline timeline(5, 0);
  timeline.play(true);
  timeline.seek(3);
  EXPECT_FALSE(timeline.playing());
  EXPECT_EQ(timeline.advance(0.0, allReady).show, 3);
  EXPECT_FALSE(timeline.advance(10.0, allReady).show);
  timeline.seek(99);
  EXPECT_EQ(timeline.position(), 4);
  timeline.step(1);
  EXPECT_EQ(timeline.position(), 0);
  timeline.step(-1);
  EXPECT_EQ(timeline.position(), 4);
}

TEST(Timeline, LooksAgainAtAChangedFile) {
  Timeline timeline(1, 0);
  EXPECT_FALSE(timeline.advance(1.0, allReady).show);
  timeline.lookAgain();
  EXPECT_EQ(timeline.advance(0.0, allReady).show, 0);
}

TEST(Timeline, AFileAloneDoesNotPlay) {
  Timeline timeline(1, 0);
  timeline.play(true);
  EXPECT_FALSE(timeline.playing());
  EXPECT_FALSE(timeline.due());
}

TEST(Timeline, KeepsItsPlaceWhenFramesAppear) {
  Timeline timeline(2, 1);
  timeline.setFrames(5, 3);
  EXPECT_EQ(timeline.position(), 3);
  EXPECT_EQ(timeline.shown(), 3);
  EXPECT_EQ(timeline.wishes(3), (std::vector<int>{3, 4, 0, 1}));
}

TEST(Timeline, SaysWhenTheNextIsDue) {
  Timeline timeline(2, 0);
  EXPECT_FALSE(timeline.due());
  timeline.setFps(4.0);
  timeline.play(true);
  EXPECT_DOUBLE_EQ(*timeline.due(), 0.25);
  timeline.advance(0.1, allReady);
  EXPECT_DOUBLE_EQ(*timeline.due(), 0.15);
}

constexpr size_t kFrameSamples = 1000;  // of a faked frame: 4000 bytes

/// A reader whose frames weigh 4000 bytes; those in `bad` throw.
struct FakedDisk {
  std::mutex mutex;
  std::vector<std::string> reads;
  std::set<std::string> bad;
  std::map<std::string, uint64_t> sizes;

  BrickVolume load(const VolumeKey& key) {
    const std::lock_guard lock(mutex);
    reads.push_back(key.path);
    if (bad.contains(key.path)) throw std::runtime_error(key.path + ": cut short");
    BrickVolume volume;
    volume.path = key.path;
    volume.samples.resize(kFrameSamples);
    return volume;
  }
  std::optional<FileStamp> stamp(const std::string& path) {
    const std::lock_guard lock(mutex);
    return FileStamp{0, sizes[path], 0};
  }
  size_t readCount() {
    const std::lock_guard lock(mutex);
    return reads.size();
  }
};

struct Reading {
  FakedDisk disk;
  std::atomic<int> wakes{0};
  ReadAhead reader;
  explicit Reading(uint64_t mostBytes)
      : reader([this](const VolumeKey& key) { return disk.load(key); }, [this] { ++wakes; }, mostBytes,
               [this](const std::string& path) { return disk.stamp(path); }) {}

  /// Waits for the frame as the window's loop does; at most ten seconds.
  ReadVolume wait(const std::string& path) {
    for (int i = 0; i < 10000; ++i) {
      if (const auto found = reader.find({path, ""})) return *found;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << path << " was never read";
    return {};
  }
  void waitForCount(size_t count) {
    for (int i = 0; i < 10000 && reader.count() < count; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

TEST(ReadAhead, ReadsTheMostUrgentFirst) {
  Reading r(1 << 20);
  r.reader.wish({{"1", ""}, {"2", ""}, {"3", ""}});
  EXPECT_EQ(r.wait("3").volume->path, "3");
  EXPECT_EQ(r.disk.reads, (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_GE(r.wakes, 2);
  EXPECT_FALSE(r.reader.find({"4", ""}));
}

TEST(ReadAhead, ABadFrameIsASentence) {
  Reading r(1 << 20);
  r.disk.bad = {"2"};
  r.reader.wish({{"1", ""}, {"2", ""}, {"3", ""}});
  EXPECT_EQ(r.wait("2").volume, nullptr);
  EXPECT_EQ(r.wait("2").complaint, "2: cut short");
  EXPECT_NE(r.wait("3").volume, nullptr);
}

TEST(ReadAhead, StaysWithinItsBytes) {
  Reading r(2 * kFrameSamples * sizeof(float) + 100);  // two frames and a bit
  std::vector<VolumeKey> wishes;
  for (int i = 0; i < 6; ++i) wishes.push_back({std::to_string(i), ""});
  for (int i = 0; i < 6; ++i) {
    const std::vector<VolumeKey> now(wishes.begin() + i, wishes.end());
    r.reader.wish(now);
    EXPECT_NE(r.wait(std::to_string(i)).volume, nullptr);
    EXPECT_LE(r.reader.bytes(), 2 * kFrameSamples * sizeof(float) + 100);
  }
  EXPECT_LE(r.disk.readCount(), 7u);  // none was read, let go and read again
}

TEST(ReadAhead, AlwaysReadsTheFirst) {
  Reading r(1);
  r.reader.wish({{"1", ""}, {"2", ""}});
  EXPECT_NE(r.wait("1").volume, nullptr);
  r.reader.wish({{"2", ""}, {"3", ""}});
  EXPECT_NE(r.wait("2").volume, nullptr);
  EXPECT_EQ(r.reader.count(), 1u);
}

TEST(ReadAhead, ReadsAChangedFileAgain) {
  Reading r(1 << 20);
  r.reader.wish({{"1", ""}});
  r.wait("1");
  {
    const std::lock_guard lock(r.disk.mutex);
    r.disk.sizes["1"] = 5;
  }
  EXPECT_FALSE(r.reader.find({"1", ""}));
  EXPECT_NE(r.wait("1").volume, nullptr);
  EXPECT_EQ(r.disk.readCount(), 2u);
}

TEST(ReadAhead, EndsWhileThereIsMuchToRead) {
  auto r = std::make_unique<Reading>(1 << 20);
  std::vector<VolumeKey> wishes;
  for (int i = 0; i < 200; ++i) wishes.push_back({std::to_string(i), ""});
  r->reader.wish(wishes);
  r.reset();  // must return
}

}  // namespace
}  // namespace nephele
