// The table of cases at which methods are held to truth one axis at a time: small volumes made in memory,
// each with its scene. Depends on preview/viewed_scene.h and volume/bricks.h.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "preview/viewed_scene.h"
#include "volume/bricks.h"

namespace nephele {

/// One point on an axis. All else is as at the table's middle: a bumpy ball of 28 voxels and world radius 1,
/// 4 optical depths thick, g 0.5, albedo 1, one sun from the side, steps of half a voxel.
struct StabilityCase {
  std::string axis;   // "optical depth"
  std::string value;  // on it, as text: "1e-3"
  std::function<BrickVolume()> volume;
  ViewedScene view;
  bool hasTruth = true;  // false: powder and octaves, which are held to be finite alone
};

/// All cases, those of an axis together and in order.
std::vector<StabilityCase> stabilityCases();

/// Frame `frame` of `count` of the slow orbit (half a degree a frame) or of the sequence (a ball whose waves
/// move), for flicker.
StabilityCase orbitFrame(int frame);
StabilityCase sequenceFrame(int frame);

}  // namespace nephele
