// What decides whether a method may be trusted with a scene, measured on the bricks and the view: the places
// on the axes of the stability map. Depends on preview/viewed_scene.h and volume/bricks.h.
#pragma once

#include "preview/viewed_scene.h"
#include "volume/bricks.h"

namespace nephele {

/// Of the volume alone. Shares are of the medium's mass.
struct BrickFacts {
  double sheetShare = 0.0;    // of voxels that are narrow (see brickFactsOf) along one or two axes
  double sheetDensity = 0.0;  // their mean, weighted by mass
  double grainShare = 0.0;    // of voxels that are narrow along all three
  double grainDensity = 0.0;
  double peak = 1.0;  // the densest sample over the largest within two voxels of it along the axes
};

/// Along an axis a voxel is narrow where the density falls below half of its own within two voxels on both
/// sides. Looks at 2·10^5 voxels at most, evenly spread. An empty volume gives zeros and a peak of 1.
BrickFacts brickFactsOf(const BrickVolume& bricks);

/// Depths are optical depths of a voxel's edge, by the largest channel of σ_t.
struct SceneFacts {
  double voxelDepth = 0.0;  // at the mean active density
  double stepVoxels = 0.0;
  double sheetShare = 0.0, sheetDepth = 0.0;
  double grainShare = 0.0, grainDepth = 0.0;
  double peak = 1.0;
  double cameraDepth = 0.0;  // where the camera stands; 0 outside the medium
  double lightDepth = 0.0;   // the largest where a point light stands
};
SceneFacts sceneFactsOf(const BrickFacts& facts, const BrickVolume& bricks, const ViewedScene& view);

}  // namespace nephele
