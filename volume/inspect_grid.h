// One grid in memory as `info` tells it. Includes OpenVDB: for volume alone.
#pragma once

#include <openvdb/openvdb.h>

#include "volume/info.h"

namespace nephele {

/// All but the content hash, which takes a walk over all values.
GridInfo inspectGrid(const openvdb::GridBase& grid);

}  // namespace nephele
