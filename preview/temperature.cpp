// Reading temperatures. Depends on what its header names.
#include "preview/temperature.h"

namespace nephele {

void addTemperature(BrickVolume& volume, const Emission& emission) {
  if (emission.on == Switch(false)) return;
  if (!emission.on && !hasFloatGrid(volume.path, emission.grid)) return;
  volume.temperature = std::make_shared<const BrickVolume>(loadBricks(volume.path, emission.grid));
}

}  // namespace nephele
