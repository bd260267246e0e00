// What the panel shows, changes and asks for. Depends on the parts named below; knows no ImGui.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "preview/app/document.h"
#include "preview/app/keys.h"
#include "preview/app/settings.h"
#include "preview/app/viewer.h"

namespace nephele {

/// What panel and keys change.
struct UiState {
  Settings settings;
  std::optional<Settings> kept;  // the split's left side
  View view = View::radiance;
  Slice slice;
  RestGoal goal;
  double divider = 0.5;  // share of the width
  int liveEdge = 64;     // voxels along the longest side of live particles' grid
  glm::dvec3 up{0.0, 0.0, 1.0};
  bool visible = true;
  bool help = false;
  bool listOpen = false;  // a list to choose from is unfolded; set to false, the panel folds it
  std::string notice;     // the last thing done or refused, as a sentence
  std::string sceneFile;  // where the scene is saved to and read from
};

/// Of particles that are moved live.
struct LiveFacts {
  bool playing = false;
  int64_t frame = 0;  // below 0: before the first frame
  uint32_t alive = 0;
  std::vector<std::string> leftOut;  // what the bake does and live particles do not
};

/// What the panel shows and cannot change.
struct UiFacts {
  const Document& document;
  LaneStats stats;
  uint64_t gpuBytes = 0;
  double framesPerSecond = 0.0;  // while things move or play; 0 at rest
  size_t undoSteps = 0, redoSteps = 0;
  std::optional<LiveFacts> live;      // while particles are moved live
  std::vector<std::string> warnings;  // what is wrong with the picture, or worth knowing of the file
};

/// What the panel asks for.
struct UiWishes {
  bool settings = false;  // UiState::settings was changed
  bool picture = false;   // another picture is needed: view, slice or goal were changed
  std::vector<Action> actions;
  std::optional<std::string> grid;
  std::optional<std::string> environment;  // path of a lat-long picture to be lit by
  std::optional<int> frame;
  std::optional<double> fps;
};

}  // namespace nephele
