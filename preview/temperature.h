// The grid of temperatures beside a density. Depends on scene and volume/bricks.h.
#pragma once

#include "scene/scene.h"
#include "volume/bricks.h"

namespace nephele {

/// Reads the grid that `emission` names from the volume's own file into volume.temperature: nothing where
/// emission is off, or left open and the file has no such grid. Throws InputError where it is on and the file
/// has none, and for a grid that cannot be read.
void addTemperature(BrickVolume& volume, const Emission& emission);

}  // namespace nephele
