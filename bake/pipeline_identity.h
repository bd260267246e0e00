// Which build of the density code this is. Defined by cmake/build_identity.cmake. Depends on nothing.
#pragma once

#include <string_view>

namespace nephele {

/// 32 hex digits of all sources that a bake's content depends on: fields, pipeline, voxelizer, particles and
/// the texts shared with the shaders. The same sources give the same digits on every machine and compiler.
std::string_view buildIdentity();

}  // namespace nephele
