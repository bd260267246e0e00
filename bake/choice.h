// `tolerance` in place of a voxel size: the coarsest voxels, half or float, the fewest octaves and the
// coarsest step of densities whose optical depths stay within it of the same recipe at half the voxel size.
// Depends on pipeline, trial; no OpenVDB.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline.h"

namespace nephele {

/// One look that was held against the same recipe at half its voxel size, float, all octaves: the worst of
/// the frames measured.
struct ChoiceTrial {
  double voxelSize = 0.0;
  Precision precision = Precision::single;
  int mostOctaves = kAllOctaves;
  double densityStep = 0.0;
  double error = 0.0;   // largest depth difference over the largest depth of all frames
  double voxels = 0.0;  // about as many active ones, but for constant space
};

struct Choice {
  Asset asset;            // the recipe's, with what was chosen
  double asked = 0.0;     // the recipe's tolerance
  double measured = 0.0;  // of what was chosen
  uint64_t rays = 0;
  std::vector<std::optional<int>> frames;  // that were measured
  std::vector<ChoiceTrial> trials;         // in the order they were made
  std::vector<std::string> leftOut;        // sentences
  double seconds = 0.0;
};

/// Rays that the search measures along; rays that what it found is confirmed by; and the share of the
/// tolerance that either may use up: the largest difference of other rays may lie higher, by half where few
/// of ten thousand find the worst place.
inline constexpr uint64_t kChoiceRays = 10000;
inline constexpr uint64_t kConfirmingRays = 50000;
inline constexpr double kChoiceShare = 0.8;

/// Steps of densities that are tried: from a sixteenth of the largest density, coarser than which no file
/// gets smaller, to a 512th, which saves a tenth of the bytes at most.
inline constexpr double kFewestLevels = 16.0, kMostLevels = 512.0;

/// Chooses for an asset with a tolerance: halves the voxels until the tolerance holds, bisects between the
/// last two sizes, then takes half precision and octaves away where that keeps it. What is left is confirmed
/// by other rays, and given its octaves again and finer voxels until they hold too. Last come steps of
/// densities: the coarsest that all of these rays hold. Fields and particles are evaluated where rays go;
/// particles are seen by as many rays from the start, which confirm as well. Sequences are measured at their
/// first, middle and last frame. The same on any number of threads and for any part of the frames. Throws
/// InputError where the tolerance asks for more voxels than is measured, saying what was reached, and where
/// the asset cannot be baked.
Choice chooseFor(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder);

/// What a look is held against: half its voxel size, float, all octaves, no step.
Asset finerThan(const Asset& look);

/// One line: what was asked, chosen, measured and left out; the file's metadata holds it.
std::string choiceAsText(const Choice& choice);

/// The largest depth difference along `rays` rays of `seed` between two looks of an asset, over the largest
/// depth of `reference`, both over all of the asset's sampled frames; measured as the search does.
double depthError(const Pipeline& pipeline, const Asset& reference, const Asset& look, uint64_t rays,
                  uint64_t seed, const std::string& outFolder);

}  // namespace nephele
