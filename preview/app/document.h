// What is open: a file or a sequence, one grid of it, and the frame that is shown; and what is on its way. No
// window and no GL. Depends on volume and the parts named below.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "preview/app/file_watch.h"
#include "preview/app/read_ahead.h"
#include "preview/app/sequence_files.h"
#include "preview/app/timeline.h"

namespace nephele {

/// One grid that a file holds.
struct GridChoice {
  std::string name;
  bool isFloat = false;  // others cannot be shown
};

/// Grids of a .vdb, in the file's order; none where it cannot be read.
std::vector<GridChoice> gridsOf(const std::string& path);

/// What there is to do after a turn of the loop.
struct DocumentNews {
  std::shared_ptr<const BrickVolume> volume;  // to be shown from now on, or nullptr
  bool otherFile = false;  // it is of another file than before: camera and medium are to be chosen anew
  std::string notice;      // a sentence for the user; empty: none
};

/// Keeps what is shown until something better has been read. Used from one thread.
class Document {
 public:
  static constexpr int kReadAhead = 8;  // frames

  /// `volume` was read from `key` when the file was as `stamp` says.
  Document(VolumeKey key, std::shared_ptr<const BrickVolume> volume, std::optional<FileStamp> stamp,
           ReadAhead& reader);

  /// Asks for another file, or another grid of this one.
  void open(const std::string& path);
  void chooseGrid(const std::string& grid);
  /// Asks for temperatures from another grid. Where they cannot be read, what is shown stays.
  void chooseHeat(const std::string& grid);
  /// The one asked for last.
  const std::string& heat() const { return heat_; }
  /// Call each turn of the loop.
  DocumentNews advance(double seconds);
  /// Call about twice a second: looks whether the file, or its folder, has changed.
  void lookAtFiles();

  Timeline& timeline() { return timeline_; }
  const Timeline& timeline() const { return timeline_; }
  const std::vector<SequenceFrame>& frames() const { return frames_; }
  const std::vector<GridChoice>& grids() const { return grids_; }
  const BrickVolume& volume() const { return *volume_; }
  std::shared_ptr<const BrickVolume> sharedVolume() const { return volume_; }
  /// Whether anything is being read that will be shown at once.
  bool waiting() const { return pending_.has_value() || timeline_.waiting(); }

 private:
  VolumeKey keyOf(int frame) const;
  void wish();
  void take(const ReadVolume& read, const VolumeKey& key);
  DocumentNews settlePending();
  DocumentNews settleFrame(double seconds);

  ReadAhead& reader_;
  std::string grid_;  // as asked for: empty is the file's own choice
  std::string heat_;  // the temperatures' grid
  std::shared_ptr<const BrickVolume> volume_;
  std::vector<SequenceFrame> frames_;
  std::vector<GridChoice> grids_;
  Timeline timeline_;
  FileWatch watch_;   // of the shown file
  FileWatch folder_;  // for frames that come and go
  std::optional<VolumeKey> pending_;
  bool reloading_ = false;
  bool otherHeat_ = false;  // was asked for, and is not there yet
};

}  // namespace nephele
