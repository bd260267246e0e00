// Walking down the levels. Depends on volume/brick_builder.h.
#include "volume/brick_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/brick_builder.h"

namespace nephele {
namespace {

double lengthOf(const glm::dvec4& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

double voxelsAt(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& point) {
  const double distance = lengthOf(worldFromIndex * glm::dvec4(point - resolution.eye, 0.0));
  const double voxel =
      std::max({lengthOf(worldFromIndex[0]), lengthOf(worldFromIndex[1]), lengthOf(worldFromIndex[2])});
  return resolution.pixels * distance / (voxel * resolution.pixelsPerRadian);
}

int levelAt(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& point) {
  const double level = std::log2(voxelsAt(resolution, worldFromIndex, point));
  constexpr double kRounding = 1e-9;
  // Also where it is NaN or minus infinity.
  return level >= 1.0 - kRounding ? static_cast<int>(std::min<double>(level + kRounding, BrickLevels::kMost))
                                  : 0;
}

class Cutter {
 public:
  Cutter(const BrickLevels& levels, const std::optional<Resolution>& resolution)
      : levels_(levels), resolution_(resolution) {}

  Cut cut() {
    const BrickVolume& finest = levels_.at(0);
    const glm::dvec3 low(finest.activeMin - 1), high(finest.activeMax);
    int top = 0;
    if (resolution_) {
      base_ = levelFor(*resolution_, finest.worldFromIndex, low, high);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                               (corner & 4) != 0 ? high.z : low.z);
        top = std::max(top, levelAt(*resolution_, finest.worldFromIndex, point));
      }
    }
    top = std::max(top, base_);
    const BrickVolume& coarsest = levels_.at(top);
    for (glm::ivec3 b(0); b.z < coarsest.brickCount.z; ++b.z)
      for (b.y = 0; b.y < coarsest.brickCount.y; ++b.y)
        for (b.x = 0; b.x < coarsest.brickCount.x; ++b.x) take(top, coarsest.brickMin + b);
    frame();
    return std::move(cut_);
  }

 private:
  void take(int level, const glm::ivec3& brick) {
    const double edge = std::ldexp(double{kBrickCells}, level);
    const glm::dvec3 low = glm::dvec3(brick) * edge;
    if (level > base_ && levelFor(*resolution_, levels_.at(0).worldFromIndex, low, low + edge) < level) {
      for (int child = 0; child < 8; ++child)
        take(level - 1, 2 * brick + glm::ivec3(child & 1, child >> 1 & 1, child >> 2));
      return;
    }
    const BrickVolume& volume = levels_.at(level);
    const int64_t entry = indexOf(volume, brick);
    const uint32_t slot = entry < 0 ? 0 : volume.index[static_cast<size_t>(entry)];
    if (slot == 0) return;
    cut_.bricks.push_back({level - base_, brick, volume.samples.data() + (size_t{slot} - 1) * kBrickVolume});
    cut_.mostRise = std::max(cut_.mostRise, level - base_);
  }

  void frame() {
    cut_.frame = frameOf(levels_.at(base_), base_);
    if (cut_.mostRise == 0) return;
    IndexFrame& f = cut_.frame;
    glm::ivec3 first = f.brickMin, last = f.brickMin + f.brickCount;
    for (const CutBrick& b : cut_.bricks) {
      const int edge = 1 << b.rise;
      first = glm::min(first, b.brick * edge);
      last = glm::max(last, (b.brick + 1) * edge);
      const BrickVolume& volume = levels_.at(base_ + b.rise);
      f.boxMin = glm::min(f.boxMin, (volume.activeMin - 1) * edge);
      f.boxMax = glm::max(f.boxMax, volume.activeMax * edge);
    }
    const int mask = (1 << cut_.mostRise) - 1;
    for (int axis = 0; axis < 3; ++axis) first[axis] &= ~mask;
    f.brickMin = first;
    f.brickCount = last - first;
    // A ray ends where the index does.
    f.boxMin = glm::max(f.boxMin, first * kBrickCells);
    f.boxMax = glm::min(f.boxMax, last * kBrickCells);
  }

  const BrickLevels& levels_;
  const std::optional<Resolution>& resolution_;
  int base_ = 0;
  Cut cut_;
};

}  // namespace

IndexFrame frameOf(const BrickVolume& volume, int level) {
  if (volume.empty()) return {level, volume.brickMin, glm::ivec3(0), glm::ivec3(0), glm::ivec3(0)};
  return {level, volume.brickMin, volume.brickCount, volume.activeMin - 1, volume.activeMax};
}

double voxelsAcross(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& low,
                    const glm::dvec3& high) {
  return voxelsAt(resolution, worldFromIndex, glm::clamp(resolution.eye, low, high));
}

int levelFor(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& low,
             const glm::dvec3& high) {
  return levelAt(resolution, worldFromIndex, glm::clamp(resolution.eye, low, high));
}

Cut cutFor(const BrickLevels& levels, const std::optional<Resolution>& resolution) {
  if (levels.at(0).empty()) return {frameOf(levels.at(0)), {}, 0};
  return Cutter(levels, resolution).cut();
}

}  // namespace nephele
