// A sparse scalar grid as plain arrays: 8³-cell bricks with a one-sided apron, and an index. This is what the
// previewer uploads, the parity tests march and the path tracer will walk. No OpenVDB and no GL in here.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace nephele {

inline constexpr int kBrickCells = 8;                                               // cells along an edge
inline constexpr int kBrickSamples = kBrickCells + 1;                               // samples along an edge
inline constexpr int kBrickVolume = kBrickSamples * kBrickSamples * kBrickSamples;  // 729 samples

/// Density is trilinear between samples at integer index positions; a cell [i, i + 1) reads samples i and i
/// + 1. Brick b covers the cells [8 b, 8 b + 8) of each axis and stores the samples 8 b … 8 b + 8. Bricks
/// whose 729 samples are all 0 are not stored, so the bricks cover the medium's whole support, which reaches
/// one voxel beyond the active box. Bricks of one constant value share one slot.
struct BrickVolume {
  std::string path;
  std::string gridName;
  glm::dmat4 worldFromIndex{
      1.0};                 // affine, column vectors; sample (i, j, k) lies at worldFromIndex · (i, j, k, 1)
  glm::ivec3 activeMin{0};  // half-open box of active voxels, index space; equal where none is active
  glm::ivec3 activeMax{0};
  glm::ivec3 brickMin{0};          // first brick of the index along each axis (index coordinate / 8)
  glm::ivec3 brickCount{0};        // bricks of the index along each axis; 0 where the grid is empty
  std::vector<uint32_t> index;     // x fastest; 0: no density; otherwise slot + 1
  std::vector<float> samples;      // 729 per slot, x fastest, then y, then z
  std::vector<float> slotMaximum;  // per slot: largest of its 729 samples
  uint64_t activeVoxels = 0;
  double maximum = 0.0;                         // largest sample
  double meanActive = 0.0;                      // mean over active voxels
  char upAxis = 'z';                            // from the file's metadata, z where it says nothing
  std::map<std::string, std::string> metadata;  // the file's and the grid's, as text
  std::vector<std::string> notes;               // what had to be left out or assumed, as sentences

  /// Temperatures, bricks of their own with an index and a transform of their own; nullptr where none were
  /// asked for (preview/temperature.h).
  std::shared_ptr<const BrickVolume> temperature;

  size_t slotCount() const { return slotMaximum.size(); }
  bool empty() const { return slotMaximum.empty(); }
};

/// Another volume of the same file and grid: with all that is said of them, without transform, box and
/// bricks.
BrickVolume withoutBricks(const BrickVolume& volume);

/// Cube root of a voxel's volume in the world.
double voxelEdge(const BrickVolume& bricks);

/// Trilinear density at an index-space position, in double precision from the stored samples; 0 outside all
/// bricks. For tests and tools: one position at a time.
double densityAt(const BrickVolume& bricks, const glm::dvec3& index);

/// Reads one grid of a .vdb. `gridName` empty: "density", else the first float grid that is a fog volume or
/// of unknown class; a note says which was taken. Throws InputError for a missing file, one that is no .vdb
/// or is cut short, a missing grid, one that is not float, a level set, a transform that is not affine or is
/// singular, values that are not finite, and an index that would need more than 1 GiB. Negative values count
/// as 0 and a note says so.
BrickVolume loadBricks(const std::string& path, const std::string& gridName = {});

/// Whether a .vdb holds a float grid of that name. Throws as loadBricks does for the file itself.
bool hasFloatGrid(const std::string& path, const std::string& gridName);

/// Makes bricks of a dense array for tests: values x fastest, `size` samples starting at index `origin`;
/// background 0.
BrickVolume bricksFromDense(const std::vector<float>& values, const glm::ivec3& size,
                            const glm::ivec3& origin, const glm::dmat4& worldFromIndex);

}  // namespace nephele
