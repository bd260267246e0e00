// The panel of lights, medium and march, and the list of keys, in Dear ImGui. Depends on imgui, scene and
// app/viewer.h.
#pragma once

#include <string>

#include "preview/app/viewer.h"

struct GLFWwindow;

namespace nephele {

/// What the panel and the keys change.
struct PanelState {
  ViewedScene view;
  glm::dvec3 up{0.0, 0.0, 1.0};
  double exposureEv = 0.0;
  bool visible = true;
  bool help = false;
  std::string title;   // file and grid
  std::string notice;  // the last thing done, as a sentence
};

/// Owns ImGui's context on one window. Leaves no files behind.
class Panel {
 public:
  /// Puts its callbacks after those the window has.
  explicit Panel(GLFWwindow* window);
  ~Panel();
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  /// Builds and draws into the current framebuffer. Returns whether something was changed that asks for a new
  /// picture (exposure does not).
  bool draw(PanelState& state, const ViewerStats& stats);
  bool wantsMouse() const;
  bool wantsKeys() const;
};

}  // namespace nephele
