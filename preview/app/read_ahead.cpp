// The reading thread. Depends on volume/bricks.h.
#include "preview/app/read_ahead.h"

#include <algorithm>
#include <exception>

#include "base/error.h"

namespace nephele {

uint64_t bytesOf(const BrickVolume& volume) {
  return sizeof(float) * (volume.samples.size() + volume.slotMaximum.size()) +
         sizeof(uint32_t) * volume.index.size();
}

ReadAhead::ReadAhead(Load load, std::function<void()> wake, uint64_t mostBytes, Stamp stamp)
    : load_(std::move(load)),
      wake_(std::move(wake)),
      mostBytes_(mostBytes),
      stamp_(std::move(stamp)),
      thread_([this] { run(); }) {}

ReadAhead::~ReadAhead() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ReadAhead::wish(const std::vector<VolumeKey>& keys) {
  {
    const std::lock_guard lock(mutex_);
    if (keys == wishes_) return;
    wishes_ = keys;
  }
  changed_.notify_all();
}

std::optional<ReadVolume> ReadAhead::find(const VolumeKey& key) {
  const std::optional<FileStamp> now = stamp_(key.path);
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return std::nullopt;
  if (found->second.result.stamp == now) return found->second.result;
  entries_.erase(found);
  changed_.notify_all();
  return std::nullopt;
}

size_t ReadAhead::count() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

uint64_t ReadAhead::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytesHeld();
}

uint64_t ReadAhead::bytesHeld() const {
  uint64_t sum = 0;
  for (const auto& [key, entry] : entries_) sum += entry.bytes;
  return sum;
}

uint64_t ReadAhead::largest() const {
  uint64_t most = 0;
  for (const auto& [key, entry] : entries_) most = std::max(most, entry.bytes);
  return most;
}

/// Lets go of what is wished for less than `rank`, the least first, until `bytes` more fit.
void ReadAhead::makeRoom(uint64_t bytes, size_t rank) {
  while (!entries_.empty() && bytesHeld() + bytes > mostBytes_) {
    auto least = entries_.end();
    size_t leastRank = rank;
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      const auto wish = std::find(wishes_.begin(), wishes_.end(), entry->first);
      const size_t place = static_cast<size_t>(wish - wishes_.begin());
      if (place > leastRank) {
        least = entry;
        leastRank = place;
      }
    }
    if (least == entries_.end()) return;
    entries_.erase(least);
  }
}

std::optional<VolumeKey> ReadAhead::next() {
  for (size_t rank = 0; rank < wishes_.size(); ++rank) {
    if (entries_.contains(wishes_[rank])) continue;
    const uint64_t expected = largest();  // frames of a sequence are much alike
    makeRoom(expected, rank);
    if (rank > 0 && bytesHeld() + expected > mostBytes_) return std::nullopt;
    return wishes_[rank];
  }
  return std::nullopt;
}

void ReadAhead::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    std::optional<VolumeKey> key;
    changed_.wait(lock, [&] { return ending_ || (key = next()).has_value(); });
    if (ending_) return;
    lock.unlock();
    Entry entry;
    entry.result.stamp = stamp_(key->path);
    try {
      entry.result.volume = std::make_shared<const BrickVolume>(load_(*key));
      entry.bytes = bytesOf(*entry.result.volume);
    } catch (const std::exception& error) {  // a bad frame is a sentence, not the end of the window
      entry.result.complaint = error.what();
    }
    lock.lock();
    entries_[*key] = std::move(entry);
    makeRoom(0, 0);
    lock.unlock();
    wake_();
    lock.lock();
  }
}

}  // namespace nephele
