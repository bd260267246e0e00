// Running the table. Depends on what its header names.
#include "bake/stability.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/trial.h"
#include "base/progress.h"
#include "volume/difference.h"

namespace nephele {
namespace {

using glm::dvec3;

/// A recipe read, with its one asset's density.
struct Recipe {
  Pipeline pipeline;
  FieldPtr field;

  explicit Recipe(const std::string& text) : pipeline(readPipeline(text, "case")) {
    field = buildField(*asset().density, contextOf(pipeline, asset()));
  }
  const Asset& asset() const { return pipeline.assets.front(); }
  double voxel() const { return asset().voxelSize; }
  /// The field's value at a place in voxels, by itself: its place is a double, its offset 0.
  double valueAt(const dvec3& voxel) const {
    const float zero = 0.0f;
    float value = 0.0f;
    field->evaluate(Points{voxel * this->voxel(), 1, &zero, &zero, &zero}, &value);
    return double(value);
  }
};

/// Calls look(index) for each voxel of the case's cube.
template <class Look>
void overCube(const BakeCase& on, Look&& look) {
  const dvec3 middle(std::round(on.middle.x), std::round(on.middle.y), std::round(on.middle.z));
  for (int x = -kCaseReach; x <= kCaseReach; ++x)
    for (int y = -kCaseReach; y <= kCaseReach; ++y)
      for (int z = -kCaseReach; z <= kCaseReach; ++z) look(middle + dvec3(x, y, z));
}

/// Blocks that leave the intervals of themselves and of the cubes above them, and values that are not finite.
void lookAtField(const BakeCase& on, const Recipe& recipe, BadDensities& bad) {
  constexpr double kEdges[] = {8.0, 16.0, 32.0, 128.0};  // of the voxelizer's cubes
  const auto cubeAt = [&](const dvec3& voxel, double edge) {
    const dvec3 low = edge * glm::floor(voxel / edge);
    return roundedOutwards({low * recipe.voxel(), (low + (edge - 1.0)) * recipe.voxel()});
  };
  const dvec3 first = double(kBlockEdge) * glm::floor((on.middle - double(kCaseReach)) / double(kBlockEdge));
  const int blocks = 2 * kCaseReach / kBlockEdge + 2;
  alignas(kBlockAlignment) float values[kBlockPoints];
  for (int n = 0; n < blocks * blocks * blocks; ++n) {
    const dvec3 low =
        first + double(kBlockEdge) * dvec3(n / blocks / blocks, n / blocks % blocks, n % blocks);
    recipe.field->evaluate(Lattice{low * recipe.voxel(), recipe.voxel()}, values);
    bad.notFinite += size_t(
        std::count_if(std::begin(values), std::end(values), [](float v) { return !std::isfinite(v); }));
    const auto [least, most] = std::minmax_element(std::begin(values), std::end(values));
    for (const double edge : kEdges) {
      const Interval bounds = recipe.field->bounds(cubeAt(low, edge));
      if (!containsValue(bounds, double(*least)) || !containsValue(bounds, double(*most)))
        ++bad.outsideBounds;
    }
  }
}

void lookAtGrid(const BakeCase& on, const BrickVolume& bricks, BadDensities& bad) {
  for (const float value : bricks.samples) {
    if (!std::isfinite(value)) ++bad.notFinite;
    if (value < 0.0f) ++bad.negative;
  }
  if (bricks.activeVoxels == 0) return;
  const dvec3 low(bricks.activeMin), high(bricks.activeMax - 1);
  for (int axis = 0; axis < 3; ++axis)
    if (low[axis] < on.middle[axis] - kCaseReach - 1 || high[axis] > on.middle[axis] + kCaseReach + 1)
      bad.elsewhere = 1;
}

std::optional<double> voxelError(const BakeCase& on, const Recipe& recipe, const BrickVolume& bricks) {
  const std::optional<Recipe> twin = on.twin.empty() ? std::nullopt : std::optional<Recipe>(on.twin);
  double squares = 0.0, sum = 0.0, count = 0.0;
  overCube(on, [&](const dvec3& voxel) {
    const double found = densityAt(bricks, voxel);
    const double truth = std::max(0.0, on.formula ? on.formula(voxel - on.middle)
                                       : twin     ? twin->valueAt(voxel - on.middle)
                                                  : recipe.valueAt(voxel));
    if (found == 0.0 && truth == 0.0) return;
    squares += (found - truth) * (found - truth);
    sum += truth;
    count += 1.0;
  });
  if (count == 0.0) return std::nullopt;
  return std::sqrt(squares / count) / (sum / count);
}

/// Against the same recipe with voxels a quarter as large.
double depthErrorOf(const Recipe& recipe, const TrialBaker& baker, const BrickVolume& bricks) {
  constexpr double kFiner = 0.25;
  constexpr uint64_t kRays = 2000;
  Asset fine = recipe.asset();
  fine.voxelSize *= kFiner;
  return depthDifference(baker.bake(0, fine).bricks, bricks, kRays).relative();
}

}  // namespace

std::vector<BakeCell> runCase(const BakeCase& on, bool depths) {
  BakeCell cell{on.mass ? BakeMeasure::mass : BakeMeasure::voxels, on.axis, on.value, {}, {}, {}};
  try {
    const Recipe recipe(on.recipe);
    const TrialBaker baker(recipe.pipeline, recipe.asset(), {std::nullopt}, {});
    const BrickVolume bricks = baker.bake(0, recipe.asset()).bricks;
    lookAtField(on, recipe, cell.bad);
    lookAtGrid(on, bricks, cell.bad);
    if (on.mass)
      cell.error = std::abs(bricks.meanActive * double(bricks.activeVoxels) / *on.mass - 1.0);
    else
      cell.error = voxelError(on, recipe, bricks);
    if (!depths || !on.depths) return {cell};
    BakeCell deep = cell;
    deep.measure = BakeMeasure::depths;
    deep.error = depthErrorOf(recipe, baker, bricks);
    return {cell, deep};
  } catch (const InputError& refusal) {
    cell.refused = refusal.diagnostics().front().sentence;
  }
  return {cell};
}

BakeStability runBakeStability(bool quiet) {
  BakeStability result;
  const std::vector<BakeCase> cases = bakeCases();
  Progress bar("cases", cases.size(), quiet);
  for (const BakeCase& on : cases) {
    for (BakeCell& cell : runCase(on, true)) result.cells.push_back(std::move(cell));
    bar.advance();
  }
  result.integrators = integratorMap();
  return result;
}

}  // namespace nephele
