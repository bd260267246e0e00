// The `particles:` of an asset and what its hashes are made of. Part of pipeline; depends on particles,
// fields, base.
#pragma once

#include "bake/field_specs.h"
#include "bake/pipeline.h"
#include "base/hash.h"

namespace nephele {

/// Reads the asset's particles, the files that they name (relative to `folder`) and the field that erodes
/// them.
void readParticles(const yaml::Node& node, const std::string& folder, FieldReader& fields, Asset& asset,
                   Diagnostics& out);

/// Feeds everything that the content of a grid of these particles depends on, but for the erosion's field.
void hashParticles(Hasher& hasher, const Asset& asset);

}  // namespace nephele
