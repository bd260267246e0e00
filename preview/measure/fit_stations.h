// Where cameras and suns stand about what octaves are fitted to. Depends on preview/viewed_scene.h and scene
// alone.
#pragma once

#include <span>

#include "preview/viewed_scene.h"

namespace nephele {

/// Where camera and sun stand about the subject, degrees: azimuths, and elevations above the ground.
struct FitStation {
  double camera, cameraUp, sun, sunUp;
  bool fitted;  // false: held back, to check
};

/// From all sides; twelve to fit to, four at each of kFittedElevations, and eight that share no camera with
/// them, and no sun.
std::span<const FitStation> fitStations();

/// The view turned to a station: as far from its target as it was, lit by the station's sun alone, light
/// marched for in voxels of the finest level.
ViewedScene viewFrom(const ViewedScene& given, const FitStation& station);

}  // namespace nephele
