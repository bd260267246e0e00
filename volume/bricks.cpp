// Builds brick arrays from any source and reads them at a point. Depends on TBB; no OpenVDB.
#include "volume/bricks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "volume/brick_builder.h"

namespace nephele {
namespace {

// Marks in the index while it is built; slots stay far below.
constexpr uint32_t kVaries = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kIsConstant = kVaries - 1;
constexpr size_t kSlotSamples = kBrickVolume;

glm::ivec3 brickAt(const BrickVolume& volume, size_t i) {
  const size_t nx = static_cast<size_t>(volume.brickCount.x), ny = static_cast<size_t>(volume.brickCount.y);
  return volume.brickMin + glm::ivec3(i % nx, i / nx % ny, i / (nx * ny));
}

size_t sampleOffset(const glm::ivec3& local) {
  return static_cast<size_t>((local.z * kBrickSamples + local.y) * kBrickSamples + local.x);
}

/// 0, kIsConstant or kVaries; `value` is the constant.
uint32_t classify(const BrickSource& source, const glm::ivec3& brick, float& value) {
  if (!source.isConstant(brick, value)) {
    float samples[kBrickVolume];
    source.read(brick, samples);
    value = samples[0];
    const auto differs = [value](float sample) { return sample != value; };
    if (std::any_of(samples, samples + kBrickVolume, differs)) return kVaries;
  }
  return value == 0.0f ? 0 : kIsConstant;
}

/// Turns marks into slots, in order of the index. Returns for each slot the brick to fill it from.
std::vector<size_t> assignSlots(BrickVolume& volume, const BrickSource& source) {
  std::vector<size_t> fillFrom;
  std::unordered_map<float, uint32_t> constants;
  for (size_t i = 0; i < volume.index.size(); ++i) {
    if (volume.index[i] == 0) continue;
    const uint32_t next = static_cast<uint32_t>(fillFrom.size()) + 1;
    NEPHELE_CHECK_LT(next, kIsConstant);
    if (volume.index[i] == kIsConstant) {
      float value = 0.0f;
      classify(source, brickAt(volume, i), value);
      const auto [known, isNew] = constants.emplace(value, next);
      volume.index[i] = known->second;
      if (!isNew) continue;
    } else {
      volume.index[i] = next;
    }
    fillFrom.push_back(i);
  }
  return fillFrom;
}

int floorDivide(int value, int divisor) {
  return value >= 0 ? value / divisor : -((-static_cast<int64_t>(value) + divisor - 1) / divisor);
}

glm::ivec3 brickOf(const glm::ivec3& cell) {
  return {floorDivide(cell.x, kBrickCells), floorDivide(cell.y, kBrickCells),
          floorDivide(cell.z, kBrickCells)};
}

/// A dense array in a space of zeros.
class DenseSource : public BrickSource {
 public:
  DenseSource(const std::vector<float>& values, const glm::ivec3& size, const glm::ivec3& origin)
      : values_(values), size_(size), origin_(origin) {}

  bool isConstant(const glm::ivec3&, float&) const override { return false; }
  void read(const glm::ivec3& brick, float* samples) const override {
    const glm::ivec3 first = brick * kBrickCells - origin_;
    for (int z = 0; z < kBrickSamples; ++z)
      for (int y = 0; y < kBrickSamples; ++y)
        for (int x = 0; x < kBrickSamples; ++x) *samples++ = at(first + glm::ivec3(x, y, z));
  }

 private:
  float at(const glm::ivec3& p) const {
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= size_.x || p.y >= size_.y || p.z >= size_.z) return 0.0f;
    const size_t nx = static_cast<size_t>(size_.x), ny = static_cast<size_t>(size_.y);
    return values_[(static_cast<size_t>(p.z) * ny + static_cast<size_t>(p.y)) * nx +
                   static_cast<size_t>(p.x)];
  }
  const std::vector<float>& values_;
  glm::ivec3 size_, origin_;
};

}  // namespace

int64_t indexOf(const BrickVolume& volume, const glm::ivec3& brick) {
  const glm::ivec3 b = brick - volume.brickMin, n = volume.brickCount;
  if (b.x < 0 || b.y < 0 || b.z < 0 || b.x >= n.x || b.y >= n.y || b.z >= n.z) return -1;
  return (static_cast<int64_t>(b.z) * n.y + b.y) * n.x + b.x;
}

void buildBricks(BrickVolume& volume, const BrickSource& source) {
  tbb::parallel_for(size_t{0}, volume.index.size(), [&](size_t i) {
    float value = 0.0f;
    if (volume.index[i] != 0) volume.index[i] = classify(source, brickAt(volume, i), value);
  });
  const std::vector<size_t> fillFrom = assignSlots(volume, source);
  volume.samples.resize(fillFrom.size() * kSlotSamples);
  volume.slotMaximum.resize(fillFrom.size());
  tbb::parallel_for(size_t{0}, fillFrom.size(), [&](size_t slot) {
    float* samples = volume.samples.data() + slot * kSlotSamples;
    source.read(brickAt(volume, fillFrom[slot]), samples);
    volume.slotMaximum[slot] = *std::max_element(samples, samples + kSlotSamples);
  });
  volume.maximum = 0.0;
  for (const float m : volume.slotMaximum) volume.maximum = std::max(volume.maximum, double{m});
  if (!fillFrom.empty()) return;
  volume.index.clear();
  volume.brickCount = glm::ivec3(0);
}

BrickVolume withoutBricks(const BrickVolume& volume) {
  BrickVolume other;
  other.path = volume.path;
  other.gridName = volume.gridName;
  other.activeVoxels = volume.activeVoxels;
  other.maximum = volume.maximum;
  other.meanActive = volume.meanActive;
  other.upAxis = volume.upAxis;
  other.metadata = volume.metadata;
  other.notes = volume.notes;
  other.temperature = volume.temperature;
  return other;
}

double voxelEdge(const BrickVolume& bricks) {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(bricks.worldFromIndex))));
}

double densityAt(const BrickVolume& bricks, const glm::dvec3& index) {
  const glm::dvec3 low = glm::dvec3(bricks.brickMin) * double{kBrickCells};
  const glm::dvec3 high = glm::dvec3(bricks.brickMin + bricks.brickCount) * double{kBrickCells};
  for (int axis = 0; axis < 3; ++axis)
    if (!(index[axis] >= low[axis] && index[axis] < high[axis])) return 0.0;
  const glm::dvec3 floored(std::floor(index.x), std::floor(index.y), std::floor(index.z));
  const glm::ivec3 cell(floored);
  const int64_t entry = indexOf(bricks, brickOf(cell));
  NEPHELE_CHECK_GT(entry, int64_t{-1});
  const uint32_t slot = bricks.index[static_cast<size_t>(entry)];
  if (slot == 0) return 0.0;
  const float* samples = bricks.samples.data() + (size_t{slot} - 1) * kSlotSamples;
  const glm::ivec3 local = cell - brickOf(cell) * kBrickCells;
  const glm::dvec3 t = index - floored;
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {  // the cell's eight corners: one bit an axis
    const glm::ivec3 o(corner & 1, corner >> 1 & 1, corner >> 2);
    const double weight = (o.x ? t.x : 1.0 - t.x) * (o.y ? t.y : 1.0 - t.y) * (o.z ? t.z : 1.0 - t.z);
    sum += weight * double{samples[sampleOffset(local + o)]};
  }
  return sum;
}

BrickVolume bricksFromDense(const std::vector<float>& values, const glm::ivec3& size,
                            const glm::ivec3& origin, const glm::dmat4& worldFromIndex) {
  NEPHELE_CHECK_GT(std::min({size.x, size.y, size.z}), 0);
  NEPHELE_CHECK_EQ(values.size(),
                   static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z));
  BrickVolume volume;
  volume.gridName = "density";
  volume.worldFromIndex = worldFromIndex;
  volume.activeMin = origin;
  volume.activeMax = origin + size;
  volume.activeVoxels = values.size();
  double sum = 0.0;
  for (const float value : values) sum += double{value};
  volume.meanActive = sum / static_cast<double>(values.size());
  // A sample reaches into the cell before it, hence one cell more at the lower side.
  volume.brickMin = brickOf(origin - 1);
  volume.brickCount = brickOf(origin + size - 1) + 1 - volume.brickMin;
  const glm::dvec3 count(volume.brickCount);
  volume.index.assign(static_cast<size_t>(count.x * count.y * count.z), 1);
  buildBricks(volume, DenseSource(values, size, origin));
  return volume;
}

}  // namespace nephele
