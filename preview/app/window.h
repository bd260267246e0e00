// The GLFW window and what hands do to it, as plain events. Depends on GLFW and gpu/gl.h.
#pragma once

#include <string>
#include <vector>

struct GLFWwindow;

namespace nephele {

/// What happened since the last poll. Drags are in window heights, right and down positive.
struct Hands {
  double orbitX = 0.0, orbitY = 0.0;
  double panX = 0.0, panY = 0.0;
  double scroll = 0.0;    // notches, towards the screen positive
  std::vector<int> keys;  // GLFW key codes pressed (not repeats)
  bool any = false;       // anything at all: the panel may want to be drawn again
};

/// Owns GLFW and one window with an OpenGL 4.5 core context, current on this thread.
class Window {
 public:
  /// Throws WorldError where there is no display (and names --render) or no such context.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes events: at once where `wait` is false, else after sleeping until there is one.
  Hands poll(bool wait);
  void swap();
  bool closing() const;
  void close();
  void framebufferSize(int& width, int& height) const;
  GLFWwindow* handle() const { return window_; }

  /// Set before poll: events that the panel takes do not move the camera.
  bool panelWantsMouse = false;
  bool panelWantsKeys = false;

 private:
  void onButton(int button, int action, int modifiers);
  void onMove(double x, double y);
  GLFWwindow* window_ = nullptr;
  Hands hands_;
  enum class Drag { none, orbit, pan } drag_ = Drag::none;
  double lastX_ = 0.0, lastY_ = 0.0;
};

}  // namespace nephele
