// GLFW behind a window object. Depends on GLFW and gpu/gl.h.
#include "preview/app/window.h"

#include "preview/gpu/gl.h"
// After glad, so that GLFW does not bring OpenGL headers of its own.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <utility>

namespace nephele {
namespace {

constexpr double kDoubleClickSeconds = 0.35;
constexpr double kDoubleClickPixels = 4.0;
constexpr double kDividerPixels = 7.0;  // from its line to where it can still be taken hold of

std::string lastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason given" : text;
}

Window& windowOf(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

}  // namespace

Window::Window(int width, int height, const std::string& title) {
  const std::string hint = "; use --render OUT.png for a picture without a display";
  if (!glfwInit()) throw WorldError("cannot open a window: no display (" + lastGlfwError() + ")" + hint);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {  // a driver may refuse to tell of resets
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_NO_ROBUSTNESS);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  }
  if (window_ == nullptr) {
    const std::string reason = lastGlfwError();
    glfwTerminate();
    throw WorldError("cannot open a window: no display with OpenGL 4.5 (" + reason + ")" + hint);
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  loadGl(reinterpret_cast<GLADloadfunc>(glfwGetProcAddress));
  listen();
  glfwGetCursorPos(window_, &lastX_, &lastY_);
}

void Window::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
    windowOf(w).onButton(button, action, modifiers);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { windowOf(w).onMove(x, y); });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    Window& window = windowOf(w);
    window.hands_.any = true;
    ++window.hands_.presses;
    if (!window.panelWantsMouse) window.hands_.scroll += y;
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    windowOf(w).onKey(key, action, modifiers);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    Window& window = windowOf(w);
    window.hands_.any = true;
    ++window.hands_.presses;
    for (int i = 0; i < count; ++i) window.hands_.drops.emplace_back(paths[i]);
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { windowOf(w).hands_.any = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { windowOf(w).hands_.any = true; });
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::onDivider(double x) const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  return divider && std::abs(x - *divider * width) <= kDividerPixels;
}

bool Window::isDoubleClick(double x, double y) {
  const double now = glfwGetTime();
  const bool twice =
      now - clickTime_ < kDoubleClickSeconds && std::hypot(x - clickX_, y - clickY_) < kDoubleClickPixels;
  clickTime_ = twice ? -1.0 : now;  // a third click is a first one again
  clickX_ = x;
  clickY_ = y;
  return twice;
}

void Window::onButton(int button, int action, int modifiers) {
  hands_.any = true;
  ++hands_.presses;
  if (action == GLFW_RELEASE) {
    hands_.released = drag_ != Dragging::none;
    drag_ = Dragging::none;
    return;
  }
  if (panelWantsMouse) return;
  const bool shift = (modifiers & GLFW_MOD_SHIFT) != 0, control = (modifiers & GLFW_MOD_CONTROL) != 0;
  // lastX_ and lastY_ are where the press happened; asked now, GLFW would tell where the cursor is by now.
  if (button == GLFW_MOUSE_BUTTON_LEFT) {
    drag_ = onDivider(lastX_) ? Dragging::divider
            : control         ? Dragging::sun
            : shift           ? Dragging::pan
                              : Dragging::orbit;
    if (drag_ == Dragging::orbit && isDoubleClick(lastX_, lastY_)) hands_.doubleClick = cursor();
  }
  if (button == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Dragging::pan;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) drag_ = Dragging::look;
}

void Window::onMove(double x, double y) {
  hands_.any = true;
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const double dx = (x - std::exchange(lastX_, x)) / (height > 0 ? height : 1);
  const double dy = (y - std::exchange(lastY_, y)) / (height > 0 ? height : 1);
  const auto add = [&](Drag& drag) {
    drag.x += dx;
    drag.y += dy;
  };
  if (drag_ == Dragging::orbit) add(hands_.orbit);
  if (drag_ == Dragging::pan) add(hands_.pan);
  if (drag_ == Dragging::look) add(hands_.look);
  if (drag_ == Dragging::sun) add(hands_.sun);
  if (drag_ == Dragging::divider && width > 0) hands_.divider = x / width;
}

void Window::onKey(int key, int action, int modifiers) {
  hands_.any = true;
  if (action != GLFW_REPEAT) ++hands_.presses;
  if (action != GLFW_PRESS || panelWantsKeys || flying()) return;
  hands_.keys.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0});
}

std::optional<Place> Window::cursor() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_, &x, &y);
  if (!(x >= 0.0 && y >= 0.0 && x < width && y < height)) return std::nullopt;
  return Place{x / width, y / height};
}

Flight Window::flight() const {
  if (!flying()) return {};
  const auto held = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0 : 0.0; };
  return {held(GLFW_KEY_W) - held(GLFW_KEY_S), held(GLFW_KEY_D) - held(GLFW_KEY_A),
          held(GLFW_KEY_E) - held(GLFW_KEY_Q)};
}

Hands Window::poll(double seconds) {
  if (seconds > 0.0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
  return std::exchange(hands_, Hands{});
}

void Window::wake() { glfwPostEmptyEvent(); }
void Window::swap() {
  requireKeptContext("showing a frame");
  glfwSwapBuffers(window_);
}
bool Window::closing() const { return glfwWindowShouldClose(window_) != 0; }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }
void Window::framebufferSize(int& width, int& height) const {
  glfwGetFramebufferSize(window_, &width, &height);
}

}  // namespace nephele
