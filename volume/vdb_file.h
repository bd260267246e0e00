// Reading and writing .vdb files through OpenVDB: whole or not at all, refused early where damaged, with the
// metadata that VDB-CONVENTIONS.md asks for. Includes OpenVDB: only bake/voxelize, bake/splat and volume may
// include this.
#pragma once

#include <openvdb/openvdb.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "volume/bricks.h"
#include "volume/provenance.h"

namespace nephele {

/// openvdb::initialize(), once; safe from any thread.
void initializeOpenVdb();

/// An empty FloatGrid: background 0, fog volume, uniform voxels of side `voxelSize` world units, sample (0,
/// 0, 0) at the world's origin. The only call of FloatGrid::create() in the project (it costs 8 s of
/// compilation a file).
openvdb::FloatGrid::Ptr makeFogGrid(const std::string& name, double voxelSize, bool saveAsHalf);

/// An empty Vec3SGrid "vel" of the same voxels: contravariant relative, world units per second.
openvdb::Vec3SGrid::Ptr makeVelocityGrid(double voxelSize, bool saveAsHalf);

/// Writes the grids to `path` with Blosc and the active mask, whole or not at all; `provenance` becomes
/// metadata of the file. Returns the file's size in bytes. Throws WorldError.
uint64_t writeVdb(const std::string& path, const openvdb::GridCPtrVec& grids, const Provenance& provenance);
/// The same with the file's metadata as given.
uint64_t writeGrids(const std::string& path, const openvdb::GridCPtrVec& grids,
                    const openvdb::MetaMap& metadata);

/// Everything in a file, after readVdbHeader(). Throws InputError or WorldError. Grids come fully loaded.
struct VdbContents {
  openvdb::GridPtrVecPtr grids;
  openvdb::MetaMap::Ptr metadata;
};
VdbContents readVdb(const std::string& path);

/// Opens a file for `body` to read parts of, without loading on demand, after readVdbHeader() has seen that
/// it is whole. Throws as readVdb does; what OpenVDB throws inside `body` becomes an InputError that names
/// the file.
void withVdbFile(const std::string& path, const std::function<void(openvdb::io::File& file)>& body);

/// The brick arrays of a float grid in memory, as loadBricks() makes them of a file. Throws as that does for
/// values and transforms, without a path.
BrickVolume bricksFromGrid(const openvdb::FloatGrid& grid);

/// Metadata as text: numbers with all their digits, vectors as "[x, y, z]", other types as OpenVDB prints
/// them.
std::map<std::string, std::string> metadataAsText(const openvdb::MetaMap& metadata);

/// Content hash of grids (DESIGN.md, section 1, last paragraph): equal for equal content whatever wrote the
/// file. Empty for value types without a hash (points, strings). In a leaf that has active voxels all 512
/// values count, since a box sampler reads the inactive ones too; leaves without any and inactive tiles do
/// not. It is that of the tree pruned at tolerance 0, whether the tree is or not. The same on any number of
/// threads. Values are hashed as given, so round to half first where half is stored.
std::string contentHash(const openvdb::GridBase& grid);

}  // namespace nephele
