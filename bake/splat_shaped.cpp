// Kernels of stretched and eroded particles. Depends on splat_shaped.h.
#include "bake/splat_shaped.h"

#include <algorithm>

namespace nephele {
namespace {

/// The squared distance, in voxels, from a place relative to the particle's centre to the line that it is
/// drawn along.
float squaredFromLine(const SplatShape& shape, const float apart[3]) {
  float dotted = 0.0f, length = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    dotted += apart[axis] * shape.stretch[axis];
    length += shape.stretch[axis] * shape.stretch[axis];
  }
  const float t = length > 0.0f ? std::clamp(dotted / length, -0.5f, 0.5f) : 0.0f;
  float squared = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float e = apart[axis] - t * shape.stretch[axis];
    squared += e * e;
  }
  return squared;
}

// Distances are compared with a little room for rounding.
constexpr float kRoom = 1.001f;

/// False where no voxel of the leaf can be within reach of the line that the particle is drawn along.
bool mayReach(const SplatFrame& f, const glm::ivec3& origin) {
  constexpr float kToCentre = 3.5f, kToCorner = 6.0622f;  // half of 7 voxels, and √3 of that
  float apart[3];
  for (int axis = 0; axis < 3; ++axis)
    apart[axis] = float(origin[axis] - f.record.cell[axis]) + kToCentre - f.record.rest[axis];
  const float reach = (f.record.radius + kToCorner) * kRoom;
  return squaredFromLine(f.shape, apart) <= reach * reach;
}

}  // namespace

/// The field on the voxels from `origin` in the particle's own frame, 0 where the kernel ends before it; null
/// where nothing erodes.
const float* SplatShaping::fieldAt(size_t n, const SplatFrame& f, const glm::ivec3& origin,
                                   float* values) const {
  if (f.shape.erosion == 0.0f) return nullptr;
  // Only what the kernel reaches is asked for: of a leaf that a particle touches, mostly a small part.
  float x[kLeafVoxels], y[kLeafVoxels], z[kLeafVoxels], found[kLeafVoxels];
  int voxel[kLeafVoxels];
  size_t count = 0;
  const float reach = f.record.radius * kRoom, perRadius = 1.0f / f.record.radius;
  for (int v = 0; v < kLeafVoxels; ++v) {
    const int step[] = {v / (kLeafEdge * kLeafEdge), v / kLeafEdge % kLeafEdge, v % kLeafEdge};
    float apart[3];
    for (int axis = 0; axis < 3; ++axis)
      apart[axis] = float(origin[axis] + step[axis] - f.record.cell[axis]) - f.record.rest[axis];
    if (squaredFromLine(f.shape, apart) >= reach * reach) continue;
    x[count] = apart[0] * perRadius;
    y[count] = apart[1] * perRadius;
    z[count] = apart[2] * perRadius;
    voxel[count++] = v;
  }
  // Each particle lies elsewhere in the field, by up to 1024 radii.
  constexpr uint32_t kTenBits = 1023;
  const uint32_t h = motion::hashBits(particles_.id.empty() ? uint32_t(n) : particles_.id[n]);
  const glm::dvec3 elsewhere(h & kTenBits, (h >> 10) & kTenBits, (h >> 20) & kTenBits);
  if (count > 0) settings_.erosion->evaluate(Points{elsewhere, count, x, y, z}, found);
  std::fill_n(values, kLeafVoxels, 0.0f);
  for (size_t k = 0; k < count; ++k) values[voxel[k]] = found[k];
  return values;
}

double SplatShaping::weights(size_t n, const SplatFrame& f, const glm::ivec3& origin, float* weights) const {
  if (!mayReach(f, origin)) return 0.0;
  float field[kLeafVoxels];
  return splatShaped(settings_.kernel, f.record, f.shape, &origin.x, fieldAt(n, f, origin, field), weights);
}

double SplatShaping::sum(size_t n, const SplatFrame& f) const {
  double sum = 0.0;
  float unused[kLeafVoxels];
  for (int x = f.low.x & ~(kLeafEdge - 1); x <= f.high.x; x += kLeafEdge)
    for (int y = f.low.y & ~(kLeafEdge - 1); y <= f.high.y; y += kLeafEdge)
      for (int z = f.low.z & ~(kLeafEdge - 1); z <= f.high.z; z += kLeafEdge)
        sum += weights(n, f, {x, y, z}, unused);
  return sum;
}

}  // namespace nephele
