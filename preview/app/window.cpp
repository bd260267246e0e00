// GLFW behind a window object. Depends on GLFW and gpu/gl.h.
#include "preview/app/window.h"

#include "preview/gpu/gl.h"
// After glad, so that GLFW does not bring OpenGL headers of its own.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <utility>

namespace nephele {
namespace {

std::string lastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason given" : text;
}

}  // namespace

Window::Window(int width, int height, const std::string& title) {
  const std::string hint = "; use --render OUT.png for a picture without a display";
  if (!glfwInit()) throw WorldError("cannot open a window: no display (" + lastGlfwError() + ")" + hint);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = lastGlfwError();
    glfwTerminate();
    throw WorldError("cannot open a window: no display with OpenGL 4.5 (" + reason + ")" + hint);
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))->onButton(button, action, modifiers);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))->onMove(x, y);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    Window* window = static_cast<Window*>(glfwGetWindowUserPointer(w));
    window->hands_.any = true;
    if (!window->panelWantsMouse) window->hands_.scroll += y;
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
    Window* window = static_cast<Window*>(glfwGetWindowUserPointer(w));
    window->hands_.any = true;
    if (action == GLFW_PRESS && !window->panelWantsKeys) window->hands_.keys.push_back(key);
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))->hands_.any = true;
  });
  glfwSetWindowRefreshCallback(
      window_, [](GLFWwindow* w) { static_cast<Window*>(glfwGetWindowUserPointer(w))->hands_.any = true; });
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::onButton(int button, int action, int modifiers) {
  hands_.any = true;
  if (action == GLFW_RELEASE) {
    drag_ = Drag::none;
    return;
  }
  if (panelWantsMouse) return;
  const bool shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  if (button == GLFW_MOUSE_BUTTON_LEFT) drag_ = shift ? Drag::pan : Drag::orbit;
  if (button == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::pan;
  glfwGetCursorPos(window_, &lastX_, &lastY_);
}

void Window::onMove(double x, double y) {
  hands_.any = true;
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const double dx = (x - std::exchange(lastX_, x)) / (height > 0 ? height : 1);
  const double dy = (y - std::exchange(lastY_, y)) / (height > 0 ? height : 1);
  if (drag_ == Drag::orbit) {
    hands_.orbitX += dx;
    hands_.orbitY += dy;
  } else if (drag_ == Drag::pan) {
    hands_.panX += dx;
    hands_.panY += dy;
  }
}

Hands Window::poll(bool wait) {
  if (wait) {
    glfwWaitEvents();
  } else {
    glfwPollEvents();
  }
  return std::exchange(hands_, Hands{});
}

void Window::swap() { glfwSwapBuffers(window_); }
bool Window::closing() const { return glfwWindowShouldClose(window_) != 0; }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::framebufferSize(int& width, int& height) const {
  glfwGetFramebufferSize(window_, &width, &height);
}

}  // namespace nephele
