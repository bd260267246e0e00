// Depths along rays: the blocks that each ray crosses are found first, then each block is evaluated once and
// summed for all of its rays. Depends on voxelize_rays.h, voxelize_fill.h, OpenVDB, TBB.
#include "bake/voxelize_rays.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "bake/voxelize_fill.h"
#include "base/error.h"

namespace nephele {
namespace {

using glm::dvec3;
using glm::ivec3;
using openvdb::Coord;

/// A block's 8³ samples hold 7³ whole cells: no block needs its neighbours'.
constexpr int kCells = kBlockEdge - 1;
/// Bounds are asked for cubes of this many blocks along an edge before they are asked for blocks.
constexpr int kCubeBits = 4, kCubeBlocks = 1 << kCubeBits;
/// So many samples of a block, or fewer, are evaluated as points: a lattice costs less by the sample.
constexpr size_t kFewSamples = 160;
/// Bits of a cube's place along an axis within a key.
constexpr int kPlaceBits = 17;
/// Pieces that are held at a time, 0.5 GB.
constexpr size_t kMostPieces = size_t(1) << 23;

/// The midpoints of one chord in one block.
struct Piece {
  uint64_t key = 0;  // of the block
  uint32_t chord = 0;
  int begin = 0, end = 0;
};

/// Where sums of one piece go.
struct PieceSum {
  double sum = 0.0;      // of densities
  uint32_t filled = 0;   // midpoints in density that varies
  float maximum = 0.0f;  // of its block's samples; kept in the first of a block's or cube's pieces
};

ivec3 floored(const dvec3& p) { return ivec3(glm::floor(p)); }

class RaySampler {
 public:
  RaySampler(const Field& field, const VoxelizeSettings& settings)
      : filler_(field, settings), voxelSize_(settings.voxelSize) {
    const openvdb::CoordBBox box = filler_.box();
    if (box.empty()) return;
    // A sample reaches one voxel far.
    low_ = ivec3(box.min().x(), box.min().y(), box.min().z()) - 1;
    high_ = ivec3(box.max().x(), box.max().y(), box.max().z()) + 1;
    for (int axis = 0; axis < 3; ++axis)
      if ((high_[axis] - low_[axis]) / kCells >> (kPlaceBits + kCubeBits) != 0)
        throw VoxelizeError("the density's box is too long for its voxels; use larger voxels");
    empty_ = false;
  }

  RayDepths run(std::span<const Chord> chords) {
    RayDepths result;
    result.depths.resize(chords.size());
    if (empty_) return result;
    walks_.resize(chords.size());
    tbb::parallel_for(size_t(0), chords.size(), [&](size_t n) { walks_[n] = walkOf(chords[n]); });
    for (size_t first = 0; first < chords.size();) {
      const size_t last = atOnce(first);
      sumUp(chords, first, last, result);
      first = last;
    }
    return result;
  }

 private:
  ChordWalk walkOf(const Chord& chord) const {
    return walkBetween(chord.from / voxelSize_, chord.to / voxelSize_, dvec3(low_), dvec3(high_));
  }

  /// Chords [first, result) have few enough pieces between them.
  size_t atOnce(size_t first) const {
    // A line crosses at most √3 blocks a block's length of it.
    constexpr double kPiecesPerStep = 1.7320508 * kDepthStepVoxels / kCells;
    double pieces = 0.0;
    size_t last = first;
    while (last < walks_.size() && (last == first || pieces < double(kMostPieces)))
      pieces += 1.0 + kPiecesPerStep * (walks_[last].end - walks_[last].begin), ++last;
    return last;
  }

  ivec3 blockOf(const dvec3& p) const { return (glm::clamp(floored(p), low_, high_) - low_) / kCells; }

  static uint64_t keyOf(const ivec3& block) {
    uint64_t cube = 0, within = 0;
    for (int axis = 0; axis < 3; ++axis) {
      cube = cube << kPlaceBits | uint64_t(block[axis] >> kCubeBits);
      within = within << kCubeBits | uint64_t(block[axis] & (kCubeBlocks - 1));
    }
    return cube << (3 * kCubeBits) | within;
  }
  static ivec3 blockOfKey(uint64_t key) {
    ivec3 block;
    uint64_t cube = key >> (3 * kCubeBits);
    for (int axis = 2; axis >= 0; --axis) {
      block[axis] = int((cube & ((uint64_t(1) << kPlaceBits) - 1)) << kCubeBits | (key & (kCubeBlocks - 1)));
      cube >>= kPlaceBits;
      key >>= kCubeBits;
    }
    return block;
  }

  void cut(uint32_t chord, std::vector<Piece>& pieces) const {
    const ChordWalk& walk = walks_[chord];
    for (int n = walk.begin; n < walk.end;) {
      const ivec3 block = blockOf(walk.at(n));
      const int end = endOf(walk, block, n);
      pieces.push_back({keyOf(block), chord, n, end});
      n = end;
    }
  }

  /// The first midpoint after n outside of the block that n lies in.
  int endOf(const ChordWalk& walk, const ivec3& block, int n) const {
    double leaves = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const int side = low_[axis] + (block[axis] + (walk.along[axis] > 0.0 ? 1 : 0)) * kCells;
      const double at = (side - walk.start[axis]) / walk.along[axis];
      if (walk.along[axis] != 0.0) leaves = std::min(leaves, at);
    }
    int end = std::clamp(int(std::ceil(leaves * walk.steps - 0.5)), n + 1, walk.end);
    // Rounding may be off by one.
    while (end > n + 1 && blockOf(walk.at(end - 1)) != block) --end;
    while (end < walk.end && blockOf(walk.at(end)) == block) ++end;
    return end;
  }

  void sumUp(std::span<const Chord> chords, size_t first, size_t last, RayDepths& result) {
    std::vector<std::vector<Piece>> found(last - first);
    tbb::parallel_for(first, last, [&](size_t n) { cut(uint32_t(n), found[n - first]); });
    std::vector<Piece> pieces;
    for (std::vector<Piece>& list : found) {
      pieces.insert(pieces.end(), list.begin(), list.end());
      list = {};
    }
    tbb::parallel_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
      return a.key != b.key ? a.key < b.key : a.chord != b.chord ? a.chord < b.chord : a.begin < b.begin;
    });
    const std::vector<PieceSum> sums = sumsOf(pieces, result);
    for (size_t n = 0; n < pieces.size(); ++n) {
      const Chord& chord = chords[pieces[n].chord];
      const double step = glm::distance(chord.from, chord.to) / walks_[pieces[n].chord].steps;
      result.depths[pieces[n].chord] += step * sums[n].sum;
      result.lengthVaried += step * sums[n].filled;
      result.maximum = std::max(result.maximum, double(sums[n].maximum));
    }
  }

  /// Borders between pieces whose keys differ after a shift.
  static std::vector<size_t> bordersOf(const std::vector<Piece>& pieces, int shift) {
    std::vector<size_t> borders;
    for (size_t n = 0; n < pieces.size(); ++n)
      if (n == 0 || pieces[n].key >> shift != pieces[n - 1].key >> shift) borders.push_back(n);
    borders.push_back(pieces.size());
    return borders;
  }

  Coord originOf(uint64_t key) const {
    const ivec3 at = low_ + blockOfKey(key) * kCells;
    return {at.x, at.y, at.z};
  }

  std::vector<PieceSum> sumsOf(const std::vector<Piece>& pieces, RayDepths& result) const {
    std::vector<PieceSum> sums(pieces.size());
    const std::vector<size_t> cubes = bordersOf(pieces, 3 * kCubeBits);
    std::atomic<uint64_t> evaluated{0};
    tbb::parallel_for(size_t(0), cubes.size() - 1, [&](size_t c) {
      const size_t begin = cubes[c], end = cubes[c + 1];
      const uint64_t corner = pieces[begin].key >> (3 * kCubeBits) << (3 * kCubeBits);
      if (const auto value = filler_.settledValue(originOf(corner), kCubeBlocks * kCells + 1)) {
        sumConstant(pieces, begin, end, *value, sums);
        return;
      }
      std::vector<size_t> blocks;
      for (size_t n = begin; n < end; ++n)
        if (n == begin || pieces[n].key != pieces[n - 1].key) blocks.push_back(n);
      blocks.push_back(end);
      tbb::parallel_for(size_t(0), blocks.size() - 1,
                        [&](size_t b) { evaluated += sumBlock(pieces, blocks[b], blocks[b + 1], sums); });
    });
    result.voxelsEvaluated += evaluated;
    return sums;
  }

  /// The pieces [begin, end), all of them in constant space.
  static void sumConstant(const std::vector<Piece>& pieces, size_t begin, size_t end, float value,
                          std::vector<PieceSum>& sums) {
    sums[begin].maximum = value;
    for (size_t n = begin; n < end; ++n) sums[n].sum = double(value) * (pieces[n].end - pieces[n].begin);
  }

  /// The pieces [begin, end), all of one block. Returns the number of voxels evaluated.
  size_t sumBlock(const std::vector<Piece>& pieces, size_t begin, size_t end,
                  std::vector<PieceSum>& sums) const {
    const Coord origin = originOf(pieces[begin].key);
    if (const auto value = filler_.settledValue(origin, kBlockEdge)) {
      sumConstant(pieces, begin, end, *value, sums);
      return 0;
    }
    const ivec3 corner(origin.x(), origin.y(), origin.z());
    alignas(kBlockAlignment) float values[kBlockPoints];
    uint16_t places[kBlockPoints];
    const size_t needed = samplesOf(pieces, begin, end, corner, places);
    const bool few = needed <= kFewSamples;
    const size_t evaluated = few ? needed : size_t(kBlockPoints);
    const LeafScan scan = few ? filler_.scan(origin, places, needed, values) : filler_.scan(origin, values);
    if (!scan.active) return evaluated;
    sums[begin].maximum = scan.maximum;
    for (size_t n = begin; n < end; ++n) {
      const ChordWalk& walk = walks_[pieces[n].chord];
      for (int k = pieces[n].begin; k < pieces[n].end; ++k) {
        const double density = densityIn(values, walk.at(k), corner);
        sums[n].sum += density;
        sums[n].filled += density > 0.0;
      }
    }
    return evaluated;
  }

  /// The samples of a block that the pieces [begin, end) read, by their places in it; returns their number.
  size_t samplesOf(const std::vector<Piece>& pieces, size_t begin, size_t end, const ivec3& corner,
                   uint16_t* places) const {
    bool needed[kBlockPoints] = {};
    for (size_t n = begin; n < end; ++n) {
      const ChordWalk& walk = walks_[pieces[n].chord];
      int before = -1;
      for (int k = pieces[n].begin; k < pieces[n].end; ++k) {
        const int cell = placeOf(cellOf(walk.at(k), corner));
        if (cell == before) continue;
        before = cell;
        for (const int x : {0, kBlockEdge * kBlockEdge})
          for (const int y : {0, kBlockEdge})
            for (const int z : {0, 1}) needed[cell + x + y + z] = true;
      }
    }
    size_t count = 0;
    for (int n = 0; n < kBlockPoints; ++n)
      if (needed[n]) places[count++] = uint16_t(n);
    return count;
  }

  static ivec3 cellOf(const dvec3& p, const ivec3& corner) {
    return glm::clamp(floored(p) - corner, 0, kCells - 1);
  }
  static int placeOf(const ivec3& sample) {
    return (sample.x * kBlockEdge + sample.y) * kBlockEdge + sample.z;
  }

  /// Between the samples of a block that begins at `corner`.
  static double densityIn(const float* values, const dvec3& p, const ivec3& corner) {
    const ivec3 cell = cellOf(p, corner);
    const dvec3 t = p - dvec3(corner + cell);
    const float* at = values + placeOf(cell);
    const auto along = [&](const float* from) { return from[0] + t.z * (double(from[1]) - from[0]); };
    const auto over = [&](const float* from) {
      const double a = along(from), b = along(from + kBlockEdge);
      return a + t.y * (b - a);
    };
    const double a = over(at), b = over(at + kBlockEdge * kBlockEdge);
    return a + t.x * (b - a);
  }

  const LeafFiller filler_;
  const double voxelSize_;
  ivec3 low_{0}, high_{0};  // index space; blocks begin at low_
  bool empty_ = true;
  std::vector<ChordWalk> walks_;
};

}  // namespace

RayDepths depthsAlong(const Field& field, const VoxelizeSettings& settings, std::span<const Chord> chords) {
  return RaySampler(field, settings).run(chords);
}

}  // namespace nephele
