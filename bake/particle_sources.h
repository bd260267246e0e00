// Where emitters of shape mesh and points emit from, out of the files that they name. Depends on fields
// (meshes), particles, volume (points in .vdb), base.
#pragma once

#include <string>

#include "particles/point_file.h"
#include "particles/simulation.h"

namespace nephele {

/// Points of a .csv, .ply or .vdb. Throws InputError as readPointFile() and readVdbPoints() do.
PointSet readPoints(const std::string& path);

/// Writes points to `path` as its extension says: .csv, .ply, .vdb. Throws WorldError.
void writePoints(const std::string& path, const PointSet& points);

/// The sites of an emitter, or null where its shape needs none: the points of its file in their order; or
/// places on a mesh, evenly over its surface or (not `surface`) its inside, no end of them. `path` is where
/// its file lies. Throws InputError: for meshes that are not closed too, where their inside is asked for.
SiteSourcePtr makeSiteSource(const Emitter& emitter, const std::string& path);

}  // namespace nephele
