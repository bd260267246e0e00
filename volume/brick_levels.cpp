// Halving a volume's resolution. Depends on volume/brick_builder.h.
#include "volume/brick_levels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "volume/brick_builder.h"

namespace nephele {
namespace {

int halfDown(int value) { return value >> 1; }  // arithmetic: towards minus infinity

/// Weighted means of a finer volume's samples.
class HalvedSource : public BrickSource {
 public:
  explicit HalvedSource(const BrickVolume& finer) : finer_(finer) {}

  bool isConstant(const glm::ivec3& brick, float& value) const override {
    // All that its means read lies in the finer bricks 2 b − 1 … 2 b + 2.
    value = 0.0f;
    for (int z = -1; z <= 2; ++z)
      for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x)
          if (samplesOf(2 * brick + glm::ivec3(x, y, z)) != nullptr) return false;
    return true;
  }

  void read(const glm::ivec3& brick, float* samples) const override {
    std::vector<float> a = gather(brick);
    // One axis after the other: (19, 19, 19) → (9, 19, 19) → (9, 9, 19) → (9, 9, 9), x fastest.
    int rows = kReach * kReach, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<float> b(a.size() / kReach * kBrickSamples);
      const int outer = rows / stride;
      for (int o = 0; o < outer; ++o)
        for (int i = 0; i < kBrickSamples; ++i)
          for (int s = 0; s < stride; ++s) {
            const float* from = a.data() + (o * kReach + 2 * i) * stride + s;
            b[static_cast<size_t>((o * kBrickSamples + i) * stride + s)] =
                0.25f * from[0] + 0.5f * from[stride] + 0.25f * from[2 * stride];
          }
      a = std::move(b);
      rows = rows / kReach * kBrickSamples;
      stride *= kBrickSamples;
    }
    std::copy(a.begin(), a.end(), samples);
  }

 private:
  static constexpr int kReach = 2 * kBrickCells + 3;  // finer samples along an axis that a brick's means read

  const float* samplesOf(const glm::ivec3& finerBrick) const {
    const int64_t entry = indexOf(finer_, finerBrick);
    if (entry < 0) return nullptr;
    const uint32_t slot = finer_.index[static_cast<size_t>(entry)];
    return slot == 0 ? nullptr : finer_.samples.data() + (size_t{slot} - 1) * kBrickVolume;
  }

  /// The finer samples from 16 b − 1 to 16 b + 17 along each axis.
  std::vector<float> gather(const glm::ivec3& brick) const {
    std::vector<float> all(kReach * kReach * kReach, 0.0f);
    const glm::ivec3 first = 2 * kBrickCells * brick - 1;
    for (int bz = -1; bz <= 2; ++bz)
      for (int by = -1; by <= 2; ++by)
        for (int bx = -1; bx <= 2; ++bx) {
          const glm::ivec3 finerBrick = 2 * brick + glm::ivec3(bx, by, bz);
          const float* samples = samplesOf(finerBrick);
          if (samples == nullptr) continue;
          const glm::ivec3 corner = finerBrick * kBrickCells;
          const glm::ivec3 low = glm::max(corner, first) - corner;
          const glm::ivec3 high = glm::min(corner + kBrickCells, first + kReach) - corner;  // its own samples
          for (int z = low.z; z < high.z; ++z)
            for (int y = low.y; y < high.y; ++y) {
              const glm::ivec3 to = corner + glm::ivec3(low.x, y, z) - first;
              if (high.x > low.x)
                std::copy_n(samples + (z * kBrickSamples + y) * kBrickSamples + low.x, high.x - low.x,
                            all.begin() + (to.z * kReach + to.y) * kReach + to.x);
            }
        }
    return all;
  }

  const BrickVolume& finer_;
};

}  // namespace

BrickVolume coarser(const BrickVolume& finer) {
  BrickVolume volume = withoutBricks(finer);
  volume.worldFromIndex = finer.worldFromIndex;
  for (int axis = 0; axis < 3; ++axis) volume.worldFromIndex[axis] *= 2.0;
  if (finer.empty()) return volume;
  for (int axis = 0; axis < 3; ++axis) {
    volume.activeMin[axis] = halfDown(finer.activeMin[axis]);
    volume.activeMax[axis] = halfDown(finer.activeMax[axis]) + 1;
    constexpr int kCellShift = 3;  // 8 cells a brick
    volume.brickMin[axis] = (volume.activeMin[axis] - 1) >> kCellShift;
    volume.brickCount[axis] = ((volume.activeMax[axis] - 1) >> kCellShift) + 1 - volume.brickMin[axis];
  }
  const glm::dvec3 count(volume.brickCount);
  volume.index.assign(static_cast<size_t>(count.x * count.y * count.z), 1);
  buildBricks(volume, HalvedSource(finer));
  return volume;
}

const BrickVolume& BrickLevels::at(int level) const {
  NEPHELE_CHECK_LE(0, level);
  NEPHELE_CHECK_LE(level, kMost);
  if (level == 0) return finest_;
  auto& made = coarser_[static_cast<size_t>(level - 1)];
  if (!made) made = std::make_unique<const BrickVolume>(coarser(at(level - 1)));
  return *made;
}

}  // namespace nephele
