// The table of recipes at which bakes are held to truth one axis at a time. Depends on GLM and base.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nephele {

/// Voxels from the middle of a case's cloud to the faces of the cube that is looked at.
inline constexpr int kCaseReach = 14;

/// One point on an axis. All else is as at the table's middle: a ball of 12 voxels filled with gradient noise
/// of three octaves, the first with 8 voxels a cell.
struct BakeCase {
  std::string axis;        // "distance from the origin, gradient noise"
  std::string value;       // on it, as text: "1e7"
  std::string recipe;      // of one asset
  glm::dvec3 middle{0.0};  // of its cloud, in voxels

  /// What the voxels are held against: the values that a formula gives at places in voxels from the middle,
  /// or those of another recipe about the origin; where there is neither, the recipe's own, each voxel
  /// evaluated alone from its place in double precision.
  std::function<double(const glm::dvec3&)> formula;
  std::string twin;

  bool depths = false;         // its optical depths are held against those of voxels a quarter as large
  std::optional<double> mass;  // in voxels of density 1: then the mass alone is held against this
};

/// All cases, those of an axis together and in order.
std::vector<BakeCase> bakeCases();

}  // namespace nephele
