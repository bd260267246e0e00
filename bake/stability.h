// Bakes run over the table of cases: where a recipe's voxels may be trusted. Depends on pipeline, trial,
// fields, volume's difference, particles; no OpenVDB.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/stability_cases.h"
#include "particles/integrator_map.h"

namespace nephele {

/// What a case's bake is held against.
enum class BakeMeasure {
  voxels,  // √(mean (x − t)²)/mean t over the voxels where either is above 0
  depths,  // the largest difference along random rays over the largest depth, as for a tolerance
  mass     // |m/t − 1|
};

/// What no density may hold.
struct BadDensities {
  size_t notFinite = 0, negative = 0;  // of the field's and the grid's values; of the grid's
  size_t outsideBounds = 0;            // blocks with a value that the field's interval leaves out
  size_t elsewhere = 0;                // 1 where the grid reaches beyond the cube that is looked at
  bool any() const { return notFinite + negative + outsideBounds + elsewhere > 0; }
};

/// One case under one measure.
struct BakeCell {
  BakeMeasure measure = BakeMeasure::voxels;
  std::string axis, value;
  std::optional<double> error;  // none: refused, or neither bake nor truth holds anything
  BadDensities bad;
  std::string refused;  // the sentence, where the recipe or its bake is refused
};

struct BakeStability {
  std::vector<BakeCell> cells;  // in the table's order; one with depths follows its voxels
  std::vector<IntegratorRow> integrators;
};

/// A case's cells: none but the voxels' (or the mass) where `depths` is false, which is much quicker.
std::vector<BakeCell> runCase(const BakeCase& on, bool depths);

/// All of the map. The same figures on any number of threads.
BakeStability runBakeStability(bool quiet);

}  // namespace nephele
