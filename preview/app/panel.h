// Everything that Dear ImGui lays over the picture. Depends on imgui and app/ui_state.h.
#pragma once

#include "preview/app/ui_state.h"

struct GLFWwindow;

namespace nephele {

/// Owns ImGui's context on one window. Leaves no files behind.
class Panel {
 public:
  /// Puts its callbacks after those the window has.
  explicit Panel(GLFWwindow* window);
  ~Panel();
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  /// Lays everything out without drawing it. ImGui shows windows only after frames that nobody should see.
  UiWishes build(UiState& state, const UiFacts& facts);
  /// Builds and draws into the current framebuffer.
  UiWishes draw(UiState& state, const UiFacts& facts);
  bool wantsMouse() const;
  bool wantsKeys() const;
  /// Whether a widget is held: its changes are one step of undo.
  bool held() const;
};

}  // namespace nephele
