// Which files are frames of one sequence. Depends on base alone.
#pragma once

#include <string>
#include <vector>

namespace nephele {

struct SequenceFrame {
  int number = 0;
  std::string path;
  bool operator==(const SequenceFrame&) const = default;
};

/// The frames beside `path` (itself among them, there or not): files in its folder whose names differ from
/// its name only in the digits at the end of the stem, written as wide (name_0001.vdb) or wider without a
/// leading zero, in order of their numbers. Without digits, or more than nine of them: `path` alone, as frame
/// 0. A folder that cannot be read counts as empty.
std::vector<SequenceFrame> findSequence(const std::string& path);

/// The position of `path` among the frames, or 0 where it is not there.
int positionOf(const std::vector<SequenceFrame>& frames, const std::string& path);

}  // namespace nephele
