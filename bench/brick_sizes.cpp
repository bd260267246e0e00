// nephele_brick_sizes FILE.vdb...: what bricks of 4, 8 and 16 cells would take and skip, one line a file and
// size. Counts, no clock. Depends on volume's brick headers.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <glm/common.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "volume/bricks.h"

namespace nephele {
namespace {

constexpr double kPercent = 100.0;

int floorDivide(int value, int divisor) { return (value >= 0 ? value : value - divisor + 1) / divisor; }

/// Which bricks of some size hold density, over the box that holds them all.
class Bricks {
 public:
  Bricks(const BrickVolume& volume, int cells) : cells_(cells) {
    const glm::ivec3 low = volume.brickMin * kBrickCells,
                     high = low + volume.brickCount * kBrickCells;  // its last sample
    for (int axis = 0; axis < 3; ++axis) {
      first_[axis] = floorDivide(low[axis], cells) - 1;
      count_[axis] = floorDivide(high[axis], cells) + 1 - first_[axis];
    }
    full_.assign(
        static_cast<size_t>(count_.x) * static_cast<size_t>(count_.y) * static_cast<size_t>(count_.z), 0);
  }

  /// A sample above 0 belongs to the brick of its cell, and to those before it whose last sample it is.
  void mark(const glm::ivec3& at) {
    glm::ivec3 last(0), first(0);
    for (int axis = 0; axis < 3; ++axis) {
      last[axis] = floorDivide(at[axis], cells_);
      first[axis] = last[axis] - (last[axis] * cells_ == at[axis] ? 1 : 0);
    }
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) full_[placeOf({x, y, z})] = 1;
  }

  size_t full() const {
    size_t bricks = 0;
    for (const uint8_t one : full_) bricks += one;
    return bricks;
  }

  /// Bricks of the smallest box around those that hold density.
  double boxed() const {
    glm::ivec3 low = count_, high(0);
    for (glm::ivec3 b(0); b.z < count_.z; ++b.z)
      for (b.y = 0; b.y < count_.y; ++b.y)
        for (b.x = 0; b.x < count_.x; ++b.x)
          if (full_[placeOf(first_ + b)] != 0) {
            low = glm::min(low, b);
            high = glm::max(high, b + 1);
          }
    const glm::dvec3 edges(high - low);
    return edges.x * edges.y * edges.z;
  }

 private:
  size_t placeOf(const glm::ivec3& brick) const {
    const glm::ivec3 b = brick - first_;
    return (static_cast<size_t>(b.z) * static_cast<size_t>(count_.y) + static_cast<size_t>(b.y)) *
               static_cast<size_t>(count_.x) +
           static_cast<size_t>(b.x);
  }
  int cells_;
  glm::ivec3 first_{0}, count_{0};
  std::vector<uint8_t> full_;
};

/// Calls look(place) for every sample above 0, index space; those that neighbouring bricks share come again.
template <class Look>
void eachSample(const BrickVolume& volume, Look&& look) {
  size_t entry = 0;
  for (glm::ivec3 b(0); b.z < volume.brickCount.z; ++b.z)
    for (b.y = 0; b.y < volume.brickCount.y; ++b.y)
      for (b.x = 0; b.x < volume.brickCount.x; ++b.x, ++entry) {
        if (volume.index[entry] == 0) continue;
        const float* sample =
            volume.samples.data() + (volume.index[entry] - 1) * static_cast<size_t>(kBrickVolume);
        const glm::ivec3 corner = (volume.brickMin + b) * kBrickCells;
        for (int z = 0; z < kBrickSamples; ++z)
          for (int y = 0; y < kBrickSamples; ++y)
            for (int x = 0; x < kBrickSamples; ++x, ++sample)
              if (*sample > 0.0f) look(corner + glm::ivec3(x, y, z));
      }
}

void tabulate(const std::string& file) {
  const BrickVolume volume = loadBricks(file);
  if (volume.empty()) throw InputError({file}, "holds no density");
  for (const int cells : {kBrickCells / 2, kBrickCells, 2 * kBrickCells}) {
    Bricks bricks(volume, cells);
    eachSample(volume, [&](const glm::ivec3& at) { bricks.mark(at); });
    const double full = static_cast<double>(bricks.full()), boxed = bricks.boxed();
    const double samples = full * (cells + 1) * (cells + 1) * (cells + 1);
    const double active = static_cast<double>(volume.activeVoxels);
    constexpr double kWordBytes = 8.0, kTexelBytes = 2.0;  // of the index; a half
    std::printf(
        "%-12s %2d cells: %7.0f bricks, %5.2f bytes a byte of active voxel, %.2f more of index, %4.1f%% "
        "skipped\n",
        std::filesystem::path(file).stem().c_str(), cells, full, samples / active,
        kWordBytes / kTexelBytes * boxed / active, kPercent * (1.0 - full / boxed));
  }
}

}  // namespace
}  // namespace nephele

int main(int argc, char** argv) {
  return nephele::runGuarded([&] {
    if (argc < 2) throw nephele::InputError({}, "usage: nephele_brick_sizes FILE.vdb...");
    for (int i = 1; i < argc; ++i) nephele::tabulate(argv[i]);
    return 0;
  });
}
