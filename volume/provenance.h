// What a baked file says of its own making. No OpenVDB: the recipe side fills it, volume writes it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace nephele {

/// Becomes file metadata: creator, up_axis, recipe_hash, seed, frame, fps, cutoff, density_step, and the
/// medium where the recipe gives one (sigma_s, sigma_a per unit density per world unit, g).
struct Provenance {
  char upAxis = 'z';
  std::string recipeHash;  // hex; equal where the asset would bake to the same content by the same sources
  int64_t seed = 0;
  std::optional<int> frame;
  bool hasMedium = false;
  std::array<double, 3> sigmaS{};
  std::array<double, 3> sigmaA{};
  double g = 0.0;
  std::optional<double> fps, cutoff;  // of particles: what the block does not say of their bake
  std::optional<double> densityStep;  // where there is one: stored densities are multiples of it
  std::string particles;  // the recipe's particle block as YAML; empty where a density made the grid
  std::string tolerance;  // what a tolerance chose, measured and left out; empty where the recipe has none
  std::optional<double> mass;  // Σ of stored densities · voxel volume, density units · world units³
};

/// Voxels below this many world units are refused: OpenVDB takes a transform of less than 3e-15 in volume for
/// one that flattens space.
inline constexpr double kSmallestVoxel = 1.5e-5;

/// "Nephele 0.1.0"; never begins with "Houdini" (Blender would turn the file).
std::string creatorName();

}  // namespace nephele
