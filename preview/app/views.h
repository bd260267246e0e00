// What the window may show of a picture, and where its slice lies. Depends on gpu/march_pass.h.
#pragma once

#include <array>
#include <string_view>

#include "preview/gpu/march_pass.h"
#include "volume/brick_cut.h"

namespace nephele {

/// In the order of shaders/display.frag.
enum class View { radiance, transmittance, opticalDepth, slice, steps, skipped };
inline constexpr int kViewCount = 6;

struct ViewRow {
  std::string_view name;
  std::string_view unit;  // of its scale; empty: shown as colour, without a scale
  double top;             // upper end of the scale; 0: follows from the picture
  MarchWrites writes;     // what the pass must write for it
};

/// The row of a view.
const ViewRow& rowOf(View view);

/// The plane of View::slice: across x, y or z of index space, at a share of the active box, in [0, 1].
struct Slice {
  int axis = 1;
  double place = 0.5;
  bool operator==(const Slice&) const = default;
};

/// Its place in voxels from the corner of the brick grid, as MarchPass::setSlice takes it.
float slicePlace(const Slice& slice, const BrickVolume& bricks, const IndexFrame& frame);

/// Upper end of the scale for values that are ≥ 0: their 99th percentile, which a few bright pixels do not
/// stretch, rounded up to 1, 2 or 5 times a power of ten; 1 where nothing is above 0.
double scaleFor(std::vector<float> values);

}  // namespace nephele
