// Writes a .vdb with leaves compressed on all threads. OpenVDB's own writer compresses them one after the
// other, and each twice. Includes OpenVDB: for volume alone.
#pragma once

#include <openvdb/openvdb.h>

#include <ostream>

namespace nephele {

/// Writes grids and file metadata as io::File does with Blosc and the active mask: the same bytes, without
/// the metadata that helps to load grids piece by piece, which costs a compression more. Needs a seekable
/// stream, whose state tells of a failure. Grids of float or Vec3f are compressed in parallel, others as
/// OpenVDB does. Beside the grids it holds a few megabytes.
void writeVdbTo(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata);

}  // namespace nephele
