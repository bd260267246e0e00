// The GLFW window and what hands do to it, as plain events. Depends on GLFW and gpu/gl.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "preview/app/keys.h"

struct GLFWwindow;

namespace nephele {

/// A movement of the mouse in window heights, right and down positive.
struct Drag {
  double x = 0.0, y = 0.0;
  bool any() const { return x != 0.0 || y != 0.0; }
};

/// A place as shares of the window's sides from its top left corner.
struct Place {
  double x = 0.0, y = 0.0;
};

/// What happened since the last poll.
struct Hands {
  Drag orbit, pan, look, sun;
  std::optional<double> divider;  // dragged to this share of the width
  double scroll = 0.0;            // notches, towards the screen positive
  std::vector<KeyPress> keys;     // pressed (not repeats)
  std::optional<Place> doubleClick;
  std::vector<std::string> drops;  // paths
  bool released = false;           // a drag has ended
  uint64_t presses = 0;  // and releases of keys and buttons (not repeats), notches of the wheel, drops
  bool any = false;      // anything at all: the panel may want to be drawn again
};

/// Where the keys of flying push: each −1, 0 or 1.
struct Flight {
  double forward = 0.0, right = 0.0, up = 0.0;
  bool any() const { return forward != 0.0 || right != 0.0 || up != 0.0; }
};

/// Owns GLFW and one window with an OpenGL 4.5 core context, current on this thread.
class Window {
 public:
  /// Throws WorldError where there is no display (and names --render) or no such context.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes events, after sleeping until there is one or `seconds` are over (0: at once).
  Hands poll(double seconds);
  /// Ends a sleep in poll(). Any thread.
  static void wake();
  /// Throws WorldError where the context was lost.
  void swap();
  bool closing() const;
  void close();
  void setTitle(const std::string& title);
  void framebufferSize(int& width, int& height) const;
  /// The cursor, where it is over the window.
  std::optional<Place> cursor() const;
  /// Whether the right button is held, which turns keys into flight; and where they push.
  bool flying() const { return drag_ == Dragging::look; }
  Flight flight() const;
  /// Whether a drag goes on, of any kind.
  bool dragging() const { return drag_ != Dragging::none; }
  GLFWwindow* handle() const { return window_; }

  /// Set before poll: events that the panel takes do not move the camera.
  bool panelWantsMouse = false;
  bool panelWantsKeys = false;
  /// Where the split's divider can be taken hold of, as a share of the width.
  std::optional<double> divider;

 private:
  enum class Dragging { none, orbit, pan, look, sun, divider };
  void listen();
  void onButton(int button, int action, int modifiers);
  void onMove(double x, double y);
  void onKey(int key, int action, int modifiers);
  bool onDivider(double x) const;
  bool isDoubleClick(double x, double y);

  GLFWwindow* window_ = nullptr;
  Hands hands_;
  Dragging drag_ = Dragging::none;
  double lastX_ = 0.0, lastY_ = 0.0;
  double clickTime_ = -1.0, clickX_ = 0.0, clickY_ = 0.0;
};

}  // namespace nephele
