// Kernels of stretched and eroded particles. Depends on splat_shaped.h.
#include "bake/splat_shaped.h"

#include <algorithm>
#include <bit>
#include <cmath>

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

/// The leaves, in units of a leaf, of all voxels that a particle can reach, both ends included.
struct LeafBox {
  glm::ivec3 low, high;
  size_t indexOf(const glm::ivec3& leaf) const {
    const glm::ivec3 size = high - low + 1, at = leaf - low;
    return (size_t(at.x) * size_t(size.y) + size_t(at.y)) * size_t(size.z) + size_t(at.z);
  }
};
LeafBox leavesOf(const SplatFrame& f) {
  constexpr int kShift = 3;  // 8 voxels; shifts of negative numbers round down
  return {{f.low.x >> kShift, f.low.y >> kShift, f.low.z >> kShift},
          {f.high.x >> kShift, f.high.y >> kShift, f.high.z >> kShift}};
}

}  // namespace

/// Voxels that a particle reaches, at most as many as a field is asked for at a time.
struct SplatShaping::Places {
  size_t count = 0;
  float x[kLeafVoxels], y[kLeafVoxels], z[kLeafVoxels];  // from its centre, in radii
  float squared[kLeafVoxels];                            // distances from its line, in radii
  float* voxels[kLeafVoxels];                            // where each one's value goes

  /// Takes in a voxel of the leaf at `origin`, unless the kernel ends before it.
  void add(const SplatFrame& f, const glm::ivec3& origin, int voxel, float* to) {
    const int step[] = {voxel / (kLeafEdge * kLeafEdge), voxel / kLeafEdge % kLeafEdge, voxel % kLeafEdge};
    float apart[3];
    for (int axis = 0; axis < 3; ++axis)
      apart[axis] = float(origin[axis] + step[axis] - f.record.cell[axis]) - f.record.rest[axis];
    const float reach = f.record.radius * kRoom, perRadius = 1.0f / f.record.radius,
                distance = squaredFromLine(f.shape, apart);
    if (distance >= reach * reach) return;
    x[count] = apart[0] * perRadius;
    y[count] = apart[1] * perRadius;
    z[count] = apart[2] * perRadius;
    squared[count] = distance * perRadius * perRadius;
    voxels[count++] = to + voxel;
  }
};

/// The field in the particle's own frame.
void SplatShaping::readField(size_t n, const Places& places, float* values) const {
  if (places.count == 0) return;
  // Each particle lies elsewhere in the field, by up to 1024 radii.
  constexpr uint32_t kTenBits = 1023;
  const uint32_t h = motion::hashBits(particles_.id.empty() ? uint32_t(n) : particles_.id[n]);
  const glm::dvec3 elsewhere(h & kTenBits, (h >> 10) & kTenBits, (h >> 20) & kTenBits);
  settings_.erosion->evaluate(Points{elsewhere, places.count, places.x, places.y, places.z}, values);
}

/// The field on the voxels from `origin`, 0 where the kernel ends before it; null where nothing erodes.
const float* SplatShaping::fieldAt(size_t n, const SplatFrame& f, const glm::ivec3& origin,
                                   float* values) const {
  if (f.shape.erosion == 0.0f) return nullptr;
  // Only what the kernel reaches is asked for: of a leaf that a particle touches, mostly a small part.
  Places places;
  float found[kLeafVoxels];
  for (int v = 0; v < kLeafVoxels; ++v) places.add(f, origin, v, values);
  readField(n, places, found);
  std::fill_n(values, kLeafVoxels, 0.0f);
  for (size_t k = 0; k < places.count; ++k) *places.voxels[k] = found[k];
  return values;
}

void SplatShaping::add(size_t n, const SplatFrame& f, float scale, std::span<const PartOfLeaf> leaves) const {
  Places places;
  const bool eaten = f.shape.erosion != 0.0f;
  const auto give = [&] {
    float found[kLeafVoxels] = {}, weights[kLeafVoxels];
    std::fill(places.squared + places.count, std::end(places.squared), 0.0f);
    if (eaten) readField(n, places, found);
    splatShapedAt(settings_.kernel, places.count, places.squared, eaten ? found : nullptr, f.shape.erosion,
                  weights);
    for (size_t k = 0; k < places.count; ++k) *places.voxels[k] += weights[k] * scale;
    places.count = 0;
  };
  constexpr int kWordBits = 64;
  for (const PartOfLeaf& leaf : leaves) {
    if (!mayReach(f, leaf.origin)) continue;
    for (size_t word = 0; word < leaf.voxels.size(); ++word)
      for (uint64_t left = leaf.voxels[word]; left != 0; left &= left - 1) {
        places.add(f, leaf.origin, int(word) * kWordBits + std::countr_zero(left), leaf.sums);
        if (places.count == kLeafVoxels) give();
      }
  }
  if (places.count > 0) give();
}

/// As weights(), whatever was kept; returns their sum, 0 where the particle surely does not reach.
double SplatShaping::evaluate(size_t n, const SplatFrame& f, const glm::ivec3& origin, float* weights) const {
  if (!mayReach(f, origin)) return 0.0;
  float field[kLeafVoxels];
  return splatShaped(settings_.kernel, f.record, f.shape, &origin.x, fieldAt(n, f, origin, field), weights);
}

/// Appends a leaf; null for one that is not reached.
void SplatShaping::Kept::add(const float* values) {
  KeptLeaf leaf;
  leaf.first = uint32_t(weights.size());
  for (int v = 0; v < kLeafVoxels && values; ++v) {
    if (!(values[v] > 0.0f)) continue;
    leaf.above[v / 64] |= uint64_t(1) << (v % 64);
    weights.push_back(values[v]);
  }
  leaves.push_back(leaf);
}

template <class Body>
double SplatShaping::sumOver(size_t n, const SplatFrame& f, const Body& body) const {
  double sum = 0.0;
  float found[kLeafVoxels];
  const LeafBox box = leavesOf(f);
  for (int x = box.low.x; x <= box.high.x; ++x)
    for (int y = box.low.y; y <= box.high.y; ++y)
      for (int z = box.low.z; z <= box.high.z; ++z) {
        const double leaf = evaluate(n, f, glm::ivec3(x, y, z) * kLeafEdge, found);
        sum += leaf;
        body(leaf > 0.0 ? found : nullptr);
      }
  return sum;
}

double SplatShaping::sum(size_t n, const SplatFrame& f) {
  Kept kept;
  bool room = !kept_.empty() && f.shape.erosion > 0.0f;  // without a field they are cheap
  const double sum = sumOver(n, f, [&](const float* weights) {
    if (!room) return;
    kept.add(weights);
    room = kept.bytes() <= keptBytes_;
  });
  if (!room) return sum;
  kept.weights.shrink_to_fit();
  // Who comes first keeps them: that decides about time alone.
  if (usedBytes_.fetch_add(kept.bytes()) + kept.bytes() <= keptBytes_)
    kept_[n] = std::move(kept);
  else
    usedBytes_.fetch_sub(kept.bytes());
  return sum;
}

double SplatShaping::sumOfFewer(size_t n, const SplatPlaces& places) const {
  // Sums of lattices with fewer voxels along a radius say nothing of each other.
  constexpr float kFewestRadius = 3.0f;
  const auto unused = [](const float*) {};
  const SplatFrame own = places.frameOf(n);
  int stride = 1;
  while (own.record.radius >= kFewestRadius * float(2 * stride)) stride *= 2;
  double before = 0.0;
  for (; stride > 1; stride /= 2) {
    const double each = double(stride) * double(stride) * double(stride);
    const double found = each * sumOver(n, places.frameOf(n, stride * settings_.voxelSize), unused);
    if (before > 0.0 && std::abs(found - before) <= kMassTolerance * found) return found;
    before = found;
  }
  return sumOver(n, own, unused);
}

bool SplatShaping::weights(size_t n, const SplatFrame& f, const glm::ivec3& origin, float* weights) const {
  if (kept_.empty() || kept_[n].leaves.empty()) return evaluate(n, f, origin, weights) > 0.0;
  const LeafBox box = leavesOf(f);
  const KeptLeaf& leaf = kept_[n].leaves[box.indexOf(origin / kLeafEdge)];
  const float* next = kept_[n].weights.data() + leaf.first;
  bool any = false;
  for (int word = 0; word < kLeafVoxels / 64; ++word)
    for (uint64_t left = leaf.above[word]; left != 0; left &= left - 1, any = true) {
      if (!any) std::fill_n(weights, kLeafVoxels, 0.0f);
      weights[word * 64 + std::countr_zero(left)] = *next++;
    }
  return any;
}

}  // namespace nephele
