// The control grid's making. Depends on volume/bricks.h and TBB.
#include "preview/truth/control_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/error.h"

namespace nephele::truth {
namespace {

using glm::ivec3;

constexpr int kSmallestEdge = 4;  // half a brick
constexpr size_t kHalves = 8;     // cells of that edge in a brick

// A cell is smooth where what its densities differ from their mean is at most this optical depth along its
// diagonal, or this share of the mean: the closed form then is near the truth, and weights stay near 1.
constexpr double kSmoothDepth = 0.5;
// In a smooth cell looks are so many that a ray through an optical depth x has a relative variance of at most
// e^(0.1 x) − 1, in most clouds a few times less.
constexpr float kLookVariance = 0.1f;
// The control of a smooth cell is at least this share of the maximum, so that a path's weight stays below its
// inverse.
constexpr float kSmallestControl = 0.125f;

struct Statistics {
  float minimum = 0.0f, maximum = 0.0f, mean = 0.0f;
};

/// Of the 5³ samples of a brick's half along each axis; the mean is the trilinear density's, hence half
/// weights at the faces.
Statistics statisticsOf(const float* samples, const ivec3& half) {
  Statistics s{samples[0], 0.0f, 0.0f};
  const ivec3 first = half * kSmallestEdge;
  s.minimum = std::numeric_limits<float>::infinity();
  double sum = 0.0;
  const auto weight = [](int i) { return i == 0 || i == kSmallestEdge ? 0.5 : 1.0; };
  for (int z = 0; z <= kSmallestEdge; ++z)
    for (int y = 0; y <= kSmallestEdge; ++y)
      for (int x = 0; x <= kSmallestEdge; ++x) {
        const int at = ((first.z + z) * kBrickSamples + first.y + y) * kBrickSamples + first.x + x;
        const float value = samples[at];
        s.minimum = std::min(s.minimum, value);
        s.maximum = std::max(s.maximum, value);
        sum += weight(x) * weight(y) * weight(z) * double{value};
      }
  s.mean = static_cast<float>(sum / (kSmallestEdge * kSmallestEdge * kSmallestEdge));
  return s;
}

/// `diagonal`: of the cell, world units.
ControlCell cellOf(const Statistics& s, double sigmaMax, double diagonal) {
  ControlCell cell{};
  cell.minimum = s.minimum;
  cell.maximum = s.maximum;
  if (s.maximum <= 0.0f) return cell;
  const float mean = std::max(s.mean, kSmallestControl * s.maximum);
  const float above = s.maximum - mean, spread = std::max(above, mean - s.minimum);
  cell.smooth = sigmaMax * double{spread} * diagonal <= kSmoothDepth;
  cell.control = cell.smooth ? mean : s.minimum;
  const float rate =
      cell.smooth ? std::max(above, spread * spread / (kLookVariance * mean)) : s.maximum - s.minimum;
  cell.residual = static_cast<float>(double{rate} * sigmaMax);
  return cell;
}

/// World lengths of a voxel's edges.
glm::dvec3 voxelSize(const BrickVolume& volume) {
  const glm::dmat4& m = volume.worldFromIndex;
  return {glm::length(glm::dvec3(m[0])), glm::length(glm::dvec3(m[1])), glm::length(glm::dvec3(m[2]))};
}

ivec3 cellsAlong(const BrickVolume& volume, int edge) {
  return (volume.brickCount * kBrickCells + edge - 1) / edge;
}

size_t product(const ivec3& v) {
  return static_cast<size_t>(v.x) * static_cast<size_t>(v.y) * static_cast<size_t>(v.z);
}

uint32_t slotAt(const BrickVolume& volume, const ivec3& brick) {
  const ivec3 n = volume.brickCount;
  if (brick.x >= n.x || brick.y >= n.y || brick.z >= n.z) return 0;
  return volume
      .index[(static_cast<size_t>(brick.z) * static_cast<size_t>(n.y) + static_cast<size_t>(brick.y)) *
                 static_cast<size_t>(n.x) +
             static_cast<size_t>(brick.x)];
}

/// Statistics of halves, slot by slot: eight for each, x fastest.
using HalfStatistics = std::vector<std::array<Statistics, kHalves>>;

HalfStatistics halvesOf(const BrickVolume& volume) {
  HalfStatistics halves(volume.slotCount());
  tbb::parallel_for(size_t{0}, halves.size(), [&](size_t slot) {
    const float* samples = volume.samples.data() + slot * static_cast<size_t>(kBrickVolume);
    for (size_t i = 0; i < kHalves; ++i)
      halves[slot][i] = statisticsOf(samples, ivec3(i & 1, i >> 1 & 1, i >> 2));
  });
  return halves;
}

/// Of the cube of `edge` voxels at cell `at`: bounds of bounds, mean of means, empty halves among them.
Statistics merged(const BrickVolume& volume, const HalfStatistics& halves, int edge, const ivec3& at) {
  if (edge == kSmallestEdge) {
    const uint32_t slot = slotAt(volume, at / 2);
    const ivec3 half = at % 2;
    return slot == 0 ? Statistics{} : halves[slot - 1][static_cast<size_t>(half.x + 2 * half.y + 4 * half.z)];
  }
  const int bricks = edge / kBrickCells;
  Statistics sum{std::numeric_limits<float>::infinity(), 0.0f, 0.0f};
  for (int z = 0; z < bricks; ++z)
    for (int y = 0; y < bricks; ++y)
      for (int x = 0; x < bricks; ++x) {
        const uint32_t slot = slotAt(volume, at * bricks + ivec3(x, y, z));
        for (size_t i = 0; i < kHalves; ++i) {
          const Statistics s = slot == 0 ? Statistics{} : halves[slot - 1][i];
          sum.minimum = std::min(sum.minimum, s.minimum);
          sum.maximum = std::max(sum.maximum, s.maximum);
          sum.mean += s.mean / static_cast<float>(kHalves * product(ivec3(bricks)));
        }
      }
  return sum;
}

/// Nanoseconds that rays are expected to spend in all cells of the grid, but for a factor.
double costOf(const ControlGrid& grid, const BrickVolume& volume) {
  constexpr double kStepCost = 4.0, kLookCost = 16.0;  // measured: nanoseconds for a step, and for a look
  constexpr double kCrossings = 1.5;  // cells that a ray of a cell's length crosses, on average
  const glm::dvec3 size = voxelSize(volume);
  const double voxel = std::cbrt(size.x * size.y * size.z);
  double looks = 0.0;
  for (const ControlCell& cell : grid.cells) looks += double{cell.residual};
  const double edge = grid.edge;
  return edge * edge * edge *
         (kLookCost * looks * voxel + kStepCost * kCrossings / edge * static_cast<double>(grid.cells.size()));
}

ControlGrid buildAt(const BrickVolume& volume, const HalfStatistics& halves, int edge, double sigmaMax) {
  ControlGrid grid;
  grid.edge = edge;
  grid.count = cellsAlong(volume, edge);
  grid.index.assign(product(grid.count), 0);
  const double diagonal = edge * glm::length(voxelSize(volume));
  const size_t nx = static_cast<size_t>(grid.count.x), ny = static_cast<size_t>(grid.count.y);
  for (size_t i = 0; i < grid.index.size(); ++i) {
    const ivec3 at(i % nx, i / nx % ny, i / (nx * ny));
    const ivec3 brick = at * edge / kBrickCells;
    if (edge <= kBrickCells && slotAt(volume, brick) == 0) continue;
    ControlCell cell = cellOf(merged(volume, halves, edge, at), sigmaMax, diagonal);
    if (cell.maximum <= 0.0f) continue;
    cell.corner = glm::vec3(brick * kBrickCells);
    cell.slot = edge <= kBrickCells ? slotAt(volume, brick) - 1 : kManyBricks;
    grid.cells.push_back(cell);
    grid.index[i] = static_cast<uint32_t>(grid.cells.size());
  }
  return grid;
}

}  // namespace

ControlGrid buildControlGrid(const BrickVolume& volume, double sigmaMax) {
  NEPHELE_CHECK_EQ(volume.empty(), false);
  constexpr size_t kMostCells = size_t{1} << 27;  // half a GiB of index
  const HalfStatistics halves = halvesOf(volume);
  int edge = kSmallestEdge;
  while (product(cellsAlong(volume, edge)) > kMostCells) edge *= 2;
  ControlGrid best = buildAt(volume, halves, edge, sigmaMax);
  for (double cost = costOf(best, volume); product(best.count) > 1;) {
    ControlGrid coarser = buildAt(volume, halves, best.edge * 2, sigmaMax);
    const double coarserCost = costOf(coarser, volume);
    if (coarserCost >= cost) break;
    cost = coarserCost;
    best = std::move(coarser);
  }
  return best;
}

}  // namespace nephele::truth
