// What a headless render tells of itself in --stats: sums over its frames. Depends on preview/method.h and
// preview/measure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "preview/measure/error_request.h"
#include "preview/method.h"

namespace nephele {

/// What --error chose and then found, for the last frame.
struct ErrorReport {
  ErrorPick pick;
  NoisyError measured;
  double secondsChoosing = 0.0, secondsMeasuring = 0.0;
  double processorMilliseconds = 0.0;  // of this process, for the picture alone
  size_t waysMeasured = 0;
  int stride = 1;
  std::optional<int> bounces;
};

/// Sums over frames, and the largest where sums mean nothing.
struct RenderTotals {
  int frames = 0;
  double secondsLoad = 0.0;
  double secondsToLastPixel = 0.0;  // from the file's first byte on, without driver start and shaders
  PictureCost cost;
  std::optional<ErrorReport> error;

  void add(const PictureCost& picture);
};

/// Writes the means of at least one frame as JSON. `asked`: the value of --error. Throws WorldError where the
/// file cannot be written.
void writeRenderStats(const std::string& path, const RenderTotals& totals, const Method& method,
                      const ViewedScene& view, double asked);

}  // namespace nephele
