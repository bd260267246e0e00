// A coarse grid over the bricks that tells the path tracer, cell by cell, what densities to expect: their
// mean, bounds, and how often to look. Depends on volume/bricks.h.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "volume/bricks.h"

namespace nephele::truth {

/// What is known of the densities in a cube of `edge` voxels, faces included. Rates are per world unit, of
/// the medium's largest extinction.
struct ControlCell {
  float control;   // a density whose optical depth is taken in closed form
  float residual;  // rate of looks at what the true density has beyond it; at least σ (maximum − control)
  float minimum;   // certain bounds
  float maximum;   // > 0
  bool smooth;    // control is near all densities, which lie on both sides of it; otherwise it is the minimum
  uint32_t slot;  // of the brick; kManyBricks where the cell is larger than one
  glm::vec3 corner;  // first corner of the cell's brick, voxels from the corner of the brick grid
};
inline constexpr uint32_t kManyBricks = ~0u;

/// Cells without density are not stored.
struct ControlGrid {
  int edge = 4;  // voxels: 4, or 8 times a power of 2
  glm::ivec3 count{0};
  std::vector<uint32_t> index;  // x fastest; 0: no density; otherwise the cell's number + 1
  std::vector<ControlCell> cells;
};

/// Builds the grid for a medium of extinction `sigmaMax` per unit density (its largest channel): of the edges
/// 4, 8, 16, … the one at which steps and looks are estimated to cost least. `volume` has density somewhere
/// and outlives the grid.
ControlGrid buildControlGrid(const BrickVolume& volume, double sigmaMax);

}  // namespace nephele::truth
