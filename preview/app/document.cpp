// Opening, reloading, playing. Depends on volume.
#include "preview/app/document.h"

#include <filesystem>
#include <utility>

#include "base/error.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

std::string nameOfFile(const std::string& path) { return std::filesystem::path(path).filename().string(); }

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace

std::vector<GridChoice> gridsOf(const std::string& path) {
  std::vector<GridChoice> grids;
  try {
    for (const VdbGridEntry& entry : readVdbHeader(path).grids)
      grids.push_back({entry.name, entry.type.starts_with("Tree_float_")});
  } catch (const std::exception&) {  // the reader of the grid itself says what is wrong
    grids.clear();
  }
  return grids;
}

Document::Document(VolumeKey key, std::shared_ptr<const BrickVolume> volume, std::optional<FileStamp> stamp,
                   ReadAhead& reader)
    : reader_(reader),
      grid_(key.grid),
      heat_(key.heat),
      volume_(std::move(volume)),
      frames_(findSequence(key.path)),
      grids_(gridsOf(key.path)),
      timeline_(static_cast<int>(frames_.size()), positionOf(frames_, key.path)),
      watch_(key.path, stamp),
      folder_(folderOf(key.path), stampOf(folderOf(key.path))) {
  wish();
}

VolumeKey Document::keyOf(int frame) const {
  return {frames_[static_cast<size_t>(frame)].path, grid_, heat_};
}

void Document::wish() {
  std::vector<VolumeKey> keys;
  if (pending_) keys.push_back(*pending_);
  // A file that stands alone is on the screen already, and need not be held twice.
  if (frames_.size() > 1 || timeline_.waiting())
    for (const int frame : timeline_.wishes(kReadAhead)) keys.push_back(keyOf(frame));
  reader_.wish(keys);
}

void Document::open(const std::string& path) {
  otherHeat_ = false;
  pending_ = VolumeKey{path, {}, heat_};
  wish();
}

void Document::chooseGrid(const std::string& grid) {
  otherHeat_ = false;
  pending_ = VolumeKey{keyOf(timeline_.shown()).path, grid, heat_};
  wish();
}

void Document::chooseHeat(const std::string& grid) {
  heat_ = grid;
  otherHeat_ = true;
  if (pending_)
    pending_->heat = heat_;
  else
    pending_ = VolumeKey{keyOf(timeline_.shown()).path, grid_, heat_};
  wish();
}

void Document::take(const ReadVolume& read, const VolumeKey& key) {
  volume_ = read.volume;
  watch_ = FileWatch(key.path, read.stamp);
}

DocumentNews Document::settlePending() {
  const VolumeKey key = *pending_;
  const std::optional<ReadVolume> read = reader_.find(key);
  if (!read) return {};
  pending_.reset();
  const bool otherHeat = std::exchange(otherHeat_, false);
  const std::string shown = keyOf(timeline_.shown()).path;
  if (!read->volume) return {nullptr, false, read->complaint + " (" + nameOfFile(shown) + " stays)"};
  take(*read, key);
  grid_ = key.grid;
  const bool otherFile = key.path != shown;
  if (otherFile) {
    frames_ = findSequence(key.path);
    grids_ = gridsOf(key.path);
    timeline_ = Timeline(static_cast<int>(frames_.size()), positionOf(frames_, key.path));
    folder_ = FileWatch(folderOf(key.path), stampOf(folderOf(key.path)));
    reloading_ = false;
  }
  if (otherFile) return {volume_, true, "opened " + nameOfFile(key.path)};
  return {volume_, false,
          otherHeat ? "temperatures from grid '" + heat_ + "'" : "showing grid '" + volume_->gridName + "'"};
}

DocumentNews Document::settleFrame(double seconds) {
  std::optional<ReadVolume> read;
  const Timeline::Turn turn = timeline_.advance(seconds, [&](int frame) {
    read = reader_.find(keyOf(frame));
    if (!read) return FrameState::pending;
    return read->volume ? FrameState::ready : FrameState::bad;
  });
  const bool again = reloading_;
  if (turn.show || turn.bad) reloading_ = false;
  if (turn.bad)
    return {nullptr, false,
            read->complaint + (again ? " (what was read before stays)" : " (the frame before stays)")};
  if (!turn.show) return {};
  take(*read, keyOf(*turn.show));
  return {volume_, false, again ? "read " + nameOfFile(keyOf(*turn.show).path) + " again" : std::string()};
}

DocumentNews Document::advance(double seconds) {
  const DocumentNews news = pending_ ? settlePending() : settleFrame(seconds);
  wish();
  return news;
}

void Document::lookAtFiles() {
  if (watch_.poll()) {
    reloading_ = true;
    if (grids_.size() != 1) grids_ = gridsOf(watch_.path());
    timeline_.lookAgain();
    wish();
  }
  if (!folder_.poll()) return;
  const std::string shown = keyOf(timeline_.shown()).path;
  std::vector<SequenceFrame> frames = findSequence(shown);
  if (frames == frames_) return;
  frames_ = std::move(frames);
  timeline_.setFrames(static_cast<int>(frames_.size()), positionOf(frames_, shown));
  wish();
}

}  // namespace nephele
