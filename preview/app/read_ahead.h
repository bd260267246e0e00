// Reads volumes in a thread of its own, those wished for first, within a bound of memory. Depends on
// volume/bricks.h and the file system.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "preview/app/file_watch.h"
#include "volume/bricks.h"

namespace nephele {

/// One grid of one file; an empty grid is the file's own choice. `heat` names the temperatures to read with
/// it where the file has them.
struct VolumeKey {
  std::string path;
  std::string grid;
  std::string heat = "temperature";
  auto operator<=>(const VolumeKey&) const = default;
};

/// What reading came to: a volume, or the sentence that says why there is none.
struct ReadVolume {
  std::shared_ptr<const BrickVolume> volume;
  std::string complaint;
  std::optional<FileStamp> stamp;  // of the file, before it was read
};

/// Bytes of a volume's arrays in main memory.
uint64_t bytesOf(const BrickVolume& volume);

/// All functions may be called from one thread at a time beside the reading one.
class ReadAhead {
 public:
  using Load = std::function<BrickVolume(const VolumeKey&)>;
  using Stamp = std::function<std::optional<FileStamp>(const std::string& path)>;

  /// `load` throws what it does not like; `wake` is called from the reading thread after each volume. Holds
  /// at most `mostBytes` of volumes, but always the first one wished for.
  ReadAhead(Load load, std::function<void()> wake, uint64_t mostBytes, Stamp stamp = stampOf);
  /// Waits for the volume that is being read, no longer.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// The volumes to have, the most urgent first. Others go when memory is short, and are not begun.
  void wish(const std::vector<VolumeKey>& keys);
  /// What was read, or nullopt while it is not. A file that changed since is forgotten, and read again if it
  /// is wished for.
  std::optional<ReadVolume> find(const VolumeKey& key);
  /// Volumes that are there, and their bytes.
  size_t count() const;
  uint64_t bytes() const;

 private:
  struct Entry {
    ReadVolume result;
    uint64_t bytes = 0;
  };
  void run();
  /// The next to read: the first wish that is not there, where memory allows; room is made for it.
  std::optional<VolumeKey> next();
  void makeRoom(uint64_t bytes, size_t rank);
  uint64_t bytesHeld() const;
  uint64_t largest() const;

  Load load_;
  std::function<void()> wake_;
  uint64_t mostBytes_;
  Stamp stamp_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<VolumeKey> wishes_;
  std::map<VolumeKey, Entry> entries_;
  bool ending_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace nephele
