// What one particle gives to the voxels round it, by SIMD. The same bits on every target. Depends on
// particles.h alone; no OpenVDB.
#pragma once

#include <cstddef>
#include <cstdint>

#include "particles/particles.h"

namespace nephele {

inline constexpr int kLeafEdge = 8;
inline constexpr int kLeafVoxels = kLeafEdge * kLeafEdge * kLeafEdge;

/// A particle of more than a voxel in index space. Its place is a voxel and a rest, so that distances to
/// voxels are the same floats whatever frame they are taken in.
struct SplatRecord {
  int32_t cell[3];  // in the frame of whoever holds the record
  float rest[3];    // [0, 1)
  float radius;     // voxels; nothing reaches beyond
  float scale;      // density for a kernel of 1
};

/// A particle that is stretched along a line, or that a field eats into.
struct SplatShape {
  float stretch[3] = {0.0f, 0.0f, 0.0f};  // the line it is drawn along, centred, in voxels
  float erosion = 0.0f;                   // radii per unit of the field
};

/// ⌊x⌋ for |x| below 2^31, without a call into the language's library.
template <class Real>
inline int32_t floorToInt(Real x) {
  const int32_t whole = int32_t(x);
  return whole - int32_t(Real(whole) > x);
}

/// The first and last voxel, relative to the cell, that a kernel of this radius can reach along an axis.
inline int splatReachBelow(float rest, float radius) { return -floorToInt(radius - rest); }
inline int splatReachAbove(float rest, float radius) { return floorToInt(rest + radius); }

/// Σ kernel over all voxels: above 0 for radius > 1. Adds up `count` records into sums[count].
void splatSums(SplatKernel kernel, const SplatRecord* records, size_t count, double* sums);

/// Sums of one leaf: values as in an OpenVDB leaf (z fastest). Those beside density are weighted by it.
struct SplatLeaf {
  float* density;               // [512]
  float (*extra)[kLeafVoxels];  // [5]: vx, vy, vz, temperature, age; or null
};
/// Properties that a particle gives to the grids beside density.
struct SplatExtras {
  float value[5];
};

/// Adds records[list[0]], records[list[1]] … to the leaf whose first voxel is `origin` in the records' frame,
/// in this order. `extras` runs beside `records`, or is null.
void splatIntoLeaf(SplatKernel kernel, const SplatRecord* records, const SplatExtras* extras,
                   const uint32_t* list, size_t count, const int32_t origin[3], const SplatLeaf& leaf);

/// A tile's voxels as one array, for particles that are small beside it: rows along z with room on both sides
/// for what lies outside the tile, which is not read.
struct SplatTile {
  static constexpr int kEdge = 64;        // voxels
  static constexpr int kLeaves = 8;       // along an axis
  static constexpr float kWidest = 4.0f;  // radius of particles that it takes: they reach over 9 voxels
  static constexpr int kBefore = 8;       // voxels of room before a row
  static constexpr int kPitch = kBefore + kEdge + 16;
  float* values;     // [kEdge][kEdge][kPitch]
  uint8_t* touched;  // [kLeaves³]: 1 where a leaf was given anything
};

/// Adds records[order[0]], records[order[1]] … of radius 1 < r ≤ kWidest. Their cells are relative to the
/// tile; their `scale` is mass over the volume of a voxel: kernels are summed and scaled here.
void splatIntoTile(SplatKernel kernel, const SplatRecord* records, const uint32_t* order, size_t count,
                   const SplatTile& tile);

/// The kernel of one stretched or eroded particle on the 8³ voxels from `origin`, not scaled: weights[512],
/// and their sum. `field` (512 values of the field there) may be null.
double splatShaped(SplatKernel kernel, const SplatRecord& record, const SplatShape& shape,
                   const int32_t origin[3], const float* field, float* weights);

/// The same at single voxels: `squared` distances from the particle's line in radii, `field` there or null.
/// All arrays are read and written up to the next multiple of kLeafEdge.
void splatShapedAt(SplatKernel kernel, size_t count, const float* squared, const float* field, float erosion,
                   float* weights);

/// What a leaf loses between its sums and what is stored: 0 where a value is kept, the value where it was
/// cut, and the difference where it was rounded. Each of 8 lanes is summed in float.
struct SplatLosses {
  double before = 0.0;  // Σ before[512]
  double cut = 0.0;     // Σ of values at or below the cutoff
  double rounded = 0.0;
};
SplatLosses splatLosses(const float* before, const float* stored, float cutoff);

/// Rounds to what half precision holds, to the nearest, ties to even; |value| at most 65504.
void roundToHalf(float* values, size_t count);

}  // namespace nephele
