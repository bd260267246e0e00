// The body of a .vdb file, walked by hand without OpenVDB: do masks, blocks and their sizes fit together?
// OpenVDB trusts those sizes, and a flipped byte makes it write beyond its memory. Depends on vdb_header.h.
#pragma once

#include <string>

#include "volume/vdb_header.h"

namespace nephele {

/// Walks metadata, transform, topology and leaf buffers of each grid whose tree is of the usual shape (5, 4,
/// 3) and value type, in files from version 222 on; other grids are left to OpenVDB. Values themselves are
/// not looked at. Throws InputError that names the file and the place where sizes do not fit, WorldError
/// where it cannot be read. Costs one pass over the masks (memory-mapped). `header` is the same file's.
void checkVdbBody(const std::string& path, const VdbHeader& header);

}  // namespace nephele
