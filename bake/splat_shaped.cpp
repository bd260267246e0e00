// Kernels of stretched and eroded particles. Depends on splat_shaped.h.
#include "bake/splat_shaped.h"

#include <algorithm>

namespace nephele {
namespace {

/// False where no voxel of the leaf can be within reach of the line that the particle is drawn along.
bool mayReach(const SplatFrame& f, const glm::ivec3& origin) {
  constexpr float kToCentre = 3.5f, kToCorner = 6.0622f;  // half of 7 voxels, and √3 of that
  float apart[3], dotted = 0.0f, length = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    apart[axis] = float(origin[axis] - f.record.cell[axis]) + kToCentre - f.record.rest[axis];
    dotted += apart[axis] * f.shape.stretch[axis];
    length += f.shape.stretch[axis] * f.shape.stretch[axis];
  }
  const float t = length > 0.0f ? std::clamp(dotted / length, -0.5f, 0.5f) : 0.0f;
  float squared = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float e = apart[axis] - t * f.shape.stretch[axis];
    squared += e * e;
  }
  const float reach = (f.record.radius + kToCorner) * 1.001f;  // room for rounding
  return squared <= reach * reach;
}

}  // namespace

/// The field on the voxels from `origin` in the particle's own frame, or null where nothing erodes.
const float* SplatShaping::fieldAt(size_t n, const SplatFrame& f, const glm::ivec3& origin,
                                   float* values) const {
  if (f.shape.erosion == 0.0f) return nullptr;
  float x[kLeafVoxels], y[kLeafVoxels], z[kLeafVoxels];
  for (int v = 0; v < kLeafVoxels; ++v) {
    const glm::ivec3 at =
        origin + glm::ivec3(v / (kLeafEdge * kLeafEdge), v / kLeafEdge % kLeafEdge, v % kLeafEdge);
    x[v] = (float(at.x - f.record.cell[0]) - f.record.rest[0]) / f.record.radius;
    y[v] = (float(at.y - f.record.cell[1]) - f.record.rest[1]) / f.record.radius;
    z[v] = (float(at.z - f.record.cell[2]) - f.record.rest[2]) / f.record.radius;
  }
  // Each particle lies elsewhere in the field, by up to 1024 radii.
  constexpr uint32_t kTenBits = 1023;
  const uint32_t h = motion::hashBits(particles_.id.empty() ? uint32_t(n) : particles_.id[n]);
  const glm::dvec3 elsewhere(h & kTenBits, (h >> 10) & kTenBits, (h >> 20) & kTenBits);
  settings_.erosion->evaluate(Points{elsewhere, size_t(kLeafVoxels), x, y, z}, values);
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
