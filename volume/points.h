// Points in .vdb files: OpenVDB's point grids, as columns of numbers. No OpenVDB in this header. Depends on
// base.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace nephele {

/// Columns by name, all of one length: x, y, z always; radius (attribute pscale or radius), vx, vy, vz (v or
/// vel), and every other attribute of floats by its own name.
using PointColumns = std::map<std::string, std::vector<float>>;

/// Reads every point grid of a file, world space, in order of grids, leaves and points. Throws InputError for
/// what readVdb() refuses and for a file without point grids.
PointColumns readVdbPoints(const std::string& path);

/// Writes one point grid, "points", whole or not at all: x, y, z, and the other columns as float attributes
/// (vx, vy, vz as the vector v, radius as pscale). Positions are stored as floats relative to voxels, so they
/// come back to within a part in 10^7 of a voxel that holds a few points. Throws WorldError.
void writeVdbPoints(const std::string& path, const PointColumns& columns);

}  // namespace nephele
