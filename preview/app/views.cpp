// The table of views and their scales. Depends on volume/bricks.h.
#include "preview/app/views.h"

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

// −ln 1e-4: where the march gives up.
constexpr double kOpaqueDepth = 9.21;

constexpr std::array<ViewRow, kViewCount> kRows{{
    {"radiance", "", 0.0, MarchWrites::radiance},
    {"transmittance", "", 0.0, MarchWrites::radiance},
    {"optical depth", "optical depths", kOpaqueDepth, MarchWrites::radiance},
    {"density slice", "density", 0.0, MarchWrites::slice},
    {"steps per pixel", "densities read", 0.0, MarchWrites::radiance},
    {"skipped share", "of the way through the box", 1.0, MarchWrites::skipped},
}};

}  // namespace

const ViewRow& rowOf(View view) { return kRows[static_cast<size_t>(view)]; }

float slicePlace(const Slice& slice, const BrickVolume& bricks, const IndexFrame& frame) {
  const int axis = slice.axis;
  // The medium reaches one voxel beyond the active box, samples lie on integers: from −1 to the box's end.
  const double low = bricks.activeMin[axis] - 1, high = bricks.activeMax[axis];
  return static_cast<float>(std::ldexp(low + slice.place * (high - low), -frame.level) -
                            double{kBrickCells} * frame.brickMin[axis]);
}

double scaleFor(std::vector<float> values) {
  constexpr double kShare = 0.99;
  std::erase_if(values, [](float v) { return !(v > 0.0f); });
  if (values.empty()) return 1.0;
  const auto top =
      values.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), top, values.end());
  const double value = double{*top};
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})  // of a power of ten, as scales are labelled
    if (value <= step * power) return step * power;
  constexpr double kNextPower = 10.0;
  return kNextPower * power;
}

}  // namespace nephele
