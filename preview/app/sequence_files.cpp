// Frames found beside a file. Depends on base and the file system.
#include "preview/app/sequence_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/frame_name.h"

namespace nephele {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostDigits = 9;  // numbers stay ints

bool hasFrameNumber(const Stem& stem) { return !stem.digits.empty() && stem.digits.size() <= kMostDigits; }

/// Whether `stem` is a frame of the sequence that `model` belongs to: 0999 and 1000 are, 1 and 0001 are not.
bool sameSequence(const Stem& stem, const Stem& model) {
  if (!hasFrameNumber(stem) || stem.head != model.head) return false;
  const size_t width = model.digits.size(), found = stem.digits.size();
  if (found == width) return true;
  // Numbers outgrow their padding: the narrower of the two widths is the padding.
  const Stem& wide = found > width ? stem : model;
  const Stem& narrow = found > width ? model : stem;
  const bool padded = narrow.digits.size() == 1 || narrow.digits[0] == '0' || wide.digits[0] != '0';
  return wide.digits[0] != '0' && padded;
}

}  // namespace

std::vector<SequenceFrame> findSequence(const std::string& path) {
  const fs::path file(path);
  const Stem model = stemOf(file.stem().string());
  if (!hasFrameNumber(model)) return {{0, path}};
  std::vector<SequenceFrame> frames{{std::stoi(model.digits), path}};
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    const fs::path name = entry->path().filename();
    if (name.extension() != file.extension() || name == file.filename()) continue;
    const Stem stem = stemOf(name.stem().string());
    if (sameSequence(stem, model))
      frames.push_back({std::stoi(stem.digits), (file.parent_path() / name).string()});
  }
  std::sort(frames.begin(), frames.end(), [](const SequenceFrame& a, const SequenceFrame& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  return frames;
}

int positionOf(const std::vector<SequenceFrame>& frames, const std::string& path) {
  const auto found =
      std::find_if(frames.begin(), frames.end(), [&](const SequenceFrame& f) { return f.path == path; });
  return found == frames.end() ? 0 : static_cast<int>(found - frames.begin());
}

}  // namespace nephele
