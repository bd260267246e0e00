// Particles → sparse grids: density, and on request vel, temperature and age, each particle's mass kept
// whole. Depends on fields, particles, volume, TBB; OpenVDB stays behind this header.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "bake/fields/field.h"
#include "particles/particles.h"
#include "volume/bricks.h"
#include "volume/chord_voxels.h"
#include "volume/provenance.h"

namespace nephele {

/// Particles in world space; all spans of one length. Those after mass may be empty where no grid or stretch
/// needs them.
struct SplatParticles {
  std::span<const float> x, y, z, radius, mass;
  std::span<const float> vx, vy, vz, temperature, age;
  std::span<const uint32_t> id;  // gives each its own part of the erosion's field
  size_t size() const { return x.size(); }
};

/// What is left out where densities are read along rays: voxels beside `only` may hold anything, and masses
/// of wide stretched or eroded particles are found from some of their voxels, to kMassTolerance.
struct SplatMeasure {
  const ChordVoxels& only;
  /// Sums of such particles' kernels at this voxel size: empty to be found, else those that the same
  /// particles had before.
  std::vector<double>& sums;
};

struct SplatSettings {
  double voxelSize = 1.0;  // world units, > 0; sample (0, 0, 0) lies at the world's origin
  SplatKernel kernel = SplatKernel::wendland;
  double cutoff = 0.001;     // values at or below become inactive and 0
  bool half = true;          // round values to half precision, as the file will store them
  double densityStep = 0.0;  // densities are rounded to multiples of this power of two first; 0: they are not
  double shutterSeconds = 0.0;
  bool vel = false, temperature = false, age = false;  // grids beside density
  FieldPtr erosion;  // read in each particle's frame: its centre is the origin, its radius 1; null for none
  double erosionAmount = 0.0;             // radii per unit of the field; values below 0 eat nothing
  std::optional<Box> box;                 // the active box of every frame, world units
  const SplatMeasure* measure = nullptr;  // for who looks along rays alone; null for all voxels
};

/// Masses in density · world units³: given = splatted + outsideBox (up to rounding), splatted = stored +
/// lostToCutoff + lostToHalf, what rounding takes, by a step too.
struct SplatLedger {
  double given = 0.0, splatted = 0.0, outsideBox = 0.0, lostToCutoff = 0.0, lostToHalf = 0.0, stored = 0.0;
};

struct SplatGrids;  // of OpenVDB

struct Splatted {
  std::shared_ptr<const SplatGrids> grids;
  SplatLedger ledger;
  uint64_t voxelsActive = 0;  // of density, but for corners of a box
  uint64_t gridBytes = 0;     // of all grids, in memory
  int longestAxis = 0;        // voxels along the longest side of the active box
  double maximum = 0.0;
};

/// Particles that cannot be splatted: a place that is not finite or too far away, a radius that is not above
/// 0, a mass below 0, a density that half precision cannot hold, too many voxels. The sentence says which
/// particle, with the numbers.
class SplatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Adds each particle's mass to the voxels that its kernel reaches, renormalised over them, so that the mass
/// in the grid is the same at any voxel size. A particle of one voxel's radius or less is shared out by
/// trilinear weights (stretched or eroded ones are taken to be a voxel in radius). The same bits on any
/// number of threads and SIMD target. No particles give empty grids. Throws SplatError.
Splatted splat(const SplatParticles& particles, const SplatSettings& settings);

/// Content hash (volume/vdb_file.h) of the grid of that name, or of all grids joined; 32 hex digits, empty
/// where there is no such grid.
std::string contentHashOf(const Splatted& splatted, const std::string& grid = {});

/// The density as plain bricks.
BrickVolume bricksOf(const Splatted& splatted);

/// Writes the grids to `path`, whole or not at all; returns the file's size in bytes. Throws WorldError.
uint64_t writeSplatted(const std::string& path, const Splatted& splatted, const Provenance& provenance);

}  // namespace nephele
