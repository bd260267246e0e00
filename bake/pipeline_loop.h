// The loop of an asset (`loop:`): where it is at a frame, and whether all motion can close it. Part of
// pipeline; depends on fields, base.
#pragma once

#include "bake/fields/motion.h"
#include "bake/pipeline.h"

namespace nephele {

/// The asset has a loop.
Loop loopOf(const Asset& asset, int64_t frame);

/// Complains of motions that the asset's loop cannot close, at their places; nothing without a loop.
void checkLoop(const Asset& asset, Diagnostics& out);

}  // namespace nephele
