// A lat-long picture as light: its texels, and a table for drawing directions by its brightness. Depends on
// base alone.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

namespace nephele {

// Cells of the table are equal in solid angle: even in azimuth and in the sine of the elevation. Powers of
// two, so that the upper bits of a random integer choose one (shaders/shared/environment.glsl).
inline constexpr int kEnvironmentCellsAround = 256;
inline constexpr int kEnvironmentCellsUp = 128;
inline constexpr int kEnvironmentCells = kEnvironmentCellsAround * kEnvironmentCellsUp;

/// Linear Rec.709 radiance over the sphere, and Walker's alias table over its cells.
struct EnvironmentMap {
  std::string path;
  int width = 0, height = 0;
  std::vector<glm::vec3> texels;  // x fastest, row 0 at the top (straight up); each ≥ 0 and finite
  /// Per cell, x (azimuth) fastest, row 0 at the top: the probability of keeping the cell, the cell to take
  /// instead, the density per steradian of directions drawn so.
  std::vector<glm::vec4> cells;

  /// Bilinear between texel centres, around in azimuth, held at the poles. u in [0, 1) from left to right, v
  /// in [0, 1] from top to bottom.
  glm::dvec3 radiance(double u, double v) const;
};

/// Makes the table for texels as above. Where all are 0 it is uniform. width and height at least 1.
EnvironmentMap makeEnvironmentMap(std::string path, int width, int height, std::vector<glm::vec3> texels);

/// Reads the channels R, G, B (or Y) of an EXR. Throws InputError for a missing file, one that is no EXR, has
/// no such channels, is larger than 2^26 texels, or holds a value that is negative or not finite.
std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::string& path);

}  // namespace nephele
